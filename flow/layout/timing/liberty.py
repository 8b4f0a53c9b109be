"""A Liberty file with areas and functions only: no figure of time in it.

The functions are those of the transistors as laid out, not those that names promise: c4m-flexcell 0.4.7's nexor2_x0
is an exclusive or.
"""

CONSTANTS = {"zero": "0", "one": "1"}


def functions(gds, names, models, tech):
    """What the cells ``names`` in ``gds`` do: dict cell -> (dict output -> expression, Storage or None).

    models: see `device_models`; tech: ExtractionPlatform. Cells without an output are left out.
    """
    from cells.extract import extract
    from cells.netlist.function import understand
    from cells.netlist.spice import parse

    found = {}
    for name in names:
        netlist = parse(extract(gds, name, tech, capacitors=False, resistors=False), origin=name)
        constant = {pin: CONSTANTS[pin] for pin in netlist.ports if pin in CONSTANTS}
        if constant:
            found[name] = constant, None
            continue
        cell = understand(netlist, models.POLARITY, models.SUPPLIES)
        if cell.functions:
            found[name] = cell.functions, cell.storage
    return found


def liberty(cells, ports, areas):
    """Text of the Liberty file. cells: as from `functions`; ports: dict cell -> its pins, supplies left out; areas:
    dict cell -> um2."""
    lines = ["library(cells) {", " delay_model : table_lookup;"]
    for cell, (outputs, storage) in cells.items():
        lines.append(f" cell({cell}) {{ area : {areas[cell]};")
        if storage:
            lines.append(_flip_flop(storage))
        lines += [
            f'  pin({pin}) {{ direction : output; function : "{outputs[pin]}"; }}'
            if pin in outputs
            else f"  pin({pin}) {{ direction : input; }}"
            for pin in ports[cell]
        ]
        lines.append(" }")
    return "\n".join([*lines, "}", ""])


def _flip_flop(storage):
    """Its Liberty group. storage: cells.netlist.function.Storage of kind 'ff'."""
    clock = storage.clock if storage.active else f"!{storage.clock}"
    forced = "".join(
        f' {name} : "{pin if level else "!" + pin}";'
        for name, value in (("clear", storage.clear), ("preset", storage.preset))
        if value
        for pin, level in [value]
    )
    return f'  ff(IQ,IQN) {{ clocked_on : "{clock}"; next_state : "{storage.data}";{forced} }}'
