"""Nets of a routed layout taken out and routed anew, others that are in their way too.

wiring   the process's rules for wires and cuts
board    the layout, net by net
window   a part of it as a grid, as one net sees it: what a wire or a cut costs at a place
search   the cheapest way between two sets of places
nets     a net from pin to pin, and its shapes
marks    where rules of spaces and antennas are broken
bargain  nets that contend for the same places
"""
