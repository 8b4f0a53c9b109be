"""Are two netlists the same circuit? For cells: a second opinion to KLayout's LVS, and one for foundry GDS."""

from collections import Counter

ROUNDS = 12


def differences(first, second):
    """Lines that say where two netlists (cells.netlist.spice.Netlist) differ; none when no difference is seen.

    Transistors with model, width and length, source and drain interchangeable, ports by name. Nets and devices are
    colored by what they touch until the colors are stable (the first refinement of graph isomorphism, which decides
    for cells: their nets differ in more than symmetry).
    """
    a, b = _colored(first), _colored(second)
    return [
        f"{who} has {count} more of {text}"
        for who, more in (("first", a - b), ("second", b - a))
        for text, count in sorted(more.items())
    ]


def _colored(netlist):
    color = {node: (node if node in netlist.ports else "") for node in netlist.nodes}
    devices = {}
    for _ in range(ROUNDS):
        touching = {node: [] for node in color}
        for t in netlist.transistors:
            ends = sorted((color[t.drain], color[t.source]))
            devices[t.name] = hash((_what(t), *ends, color[t.gate], color[t.bulk]))
            for role, node in (("channel", t.drain), ("channel", t.source), ("gate", t.gate), ("bulk", t.bulk)):
                touching[node].append((role, devices[t.name]))
        color = {
            node: (node if node in netlist.ports else hash((was, *sorted(touching[node]))).__str__())
            for node, was in color.items()
        }
    return Counter(f"{_what(t)} between {_named(netlist, t)} ({devices[t.name]:x})" for t in netlist.transistors)


def _what(t):
    return f"{t.model} w={t.size['w']:.3g} l={t.size['l']:.3g}"


def _named(netlist, t):
    return ", ".join(sorted(node if node in netlist.ports else "a net" for node in (t.drain, t.gate, t.source)))
