"""What the metal of a GDS joins, pins of its blocks and of the die, and how that differs from the nets asked for."""


def nets(gds, cells, known, thick):
    """list of sets of (block, pin): what each net of the top cell joins.

    cells: dict cell -> block. known: CoriolisPlatform; thick: TopMetal. A pin of a block is named by its text on the wire's pin
    layer in the block's own cell, one of the die ('die') by that in the top cell; metal of a block without a name is
    ('block', '?...'). KLayout extracts the wires and cuts of all cells, transistors aside.
    """
    import klayout.db as db

    layout = db.Layout()
    layout.read(str(gds))
    (top,) = layout.top_cells()
    l2n = db.LayoutToNetlist(db.RecursiveShapeIterator(layout, top, []))
    metal = []
    for wire in (*known.metals, thick.metal):
        metal.append(l2n.make_polygon_layer(layout.layer(*wire.gds), wire.name))
        names = l2n.make_text_layer(layout.layer(*wire.pin), f"{wire.name}_pin")
        l2n.connect(metal[-1])
        l2n.connect(metal[-1], names)
    for level, cut in enumerate((*known.vias, thick.via)):
        between = l2n.make_polygon_layer(layout.layer(*cut.gds), cut.name)
        l2n.connect(between)
        l2n.connect(metal[level], between)
        l2n.connect(between, metal[level + 1])
    l2n.extract_netlist()
    circuit = l2n.netlist().circuit_by_name(top.name)
    return [found for net in circuit.each_net() if (found := _ends(net, cells))]


def _ends(net, cells):
    ends = {("die", name) for name in net.name.split(",") if name}
    for reference in net.each_subcircuit_pin():
        circuit = reference.subcircuit().circuit_ref()
        inner = circuit.net_for_pin(reference.pin_id())
        for pin in (inner.name or f"?{inner.expanded_name()}").split(","):
            ends.add((cells.get(circuit.name, circuit.name), pin))
    return ends


def compare(found, asked):
    """(dict net -> its pins that are not on the net's largest part, dict 'net, net' -> pins that are on one net).

    found: of `nets`. asked: dict net -> pins, pairs (block, pin). A pin of no net is as a net of its own.
    """
    of = {tuple(end): net for net, ends in asked.items() for end in ends}
    parts, shorts = {}, {}
    for ends in found:
        here = {}
        for end in ends:
            here.setdefault(of.get(end, " ".join(end)), []).append(end)
        if len(here) > 1:
            shorts[", ".join(sorted(here))] = sorted(ends)
        for net, own in here.items():
            parts.setdefault(net, []).append(set(own))
    opens = {}
    for net, ends in asked.items():
        largest = max(parts.get(net, [set()]), key=len)
        lacking = {tuple(end) for end in ends} - largest
        if lacking or len(parts.get(net, ())) > 1:
            opens[net] = sorted(lacking)
    return opens, shorts
