"""Nets that the router left open, taken out and routed anew by a search over the layout as it is.

    wiring   the process's rules for wires and cuts
    window   a part of the layout as a grid: where a wire or a cut may lie
    search   the cheapest way between two sets of its places
    nets     a net from pin to pin, and its shapes
"""
