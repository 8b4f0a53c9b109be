"""Rip-up and reroute with negotiated congestion (PathFinder) of a layout that is nearly routed.

rules       rules of the metal layers and vias, in nm
board       the layout, net by net
window      a part of it as a grid, as one net sees it: the cost of a segment or a via at a place
search      the cheapest path between two sets of places
route       the shapes of a net
nets        a net from pin to pin
violations  where rules of space and antennas are broken
negotiate   nets that contend for the same places
"""
