"""Routing of all nets by negotiated congestion (PathFinder) on a grid of tracks.

rules       rules of the metal layers and vias, in nm
index       boxes by place
grid        places, what is at them, and the cheapest path over them
board       the layout, net by net
view        the board as one net sees it
access      how a pin is met
route       the shapes of a net
area        the least area and width of a route's pieces
nets        a net from pin to pin
violations  where rules of space and antennas are broken
negotiate   nets that contend for the same places
"""
