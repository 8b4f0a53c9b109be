"""A Liberty file of areas and functions: enough for synthesis by area, until the characterizer has run."""


def liberty(cells, canvas):
    """Text for ``cells`` (cells.compact.pdk.DrawnCell). No delays: pins have directions, functions and areas only."""
    lines = [
        "library(compact) {",
        "  delay_model : table_lookup;",
        '  time_unit : "1ns"; voltage_unit : "1V"; '
        'current_unit : "1mA"; pulling_resistance_unit : "1kohm"; leakage_power_unit : "1nW";',
        "  capacitive_load_unit(1.0, pf);",
    ]
    for cell in cells:
        if cell.schematic.outputs:
            lines += _cell(cell, canvas)
    return "\n".join([*lines, "}", ""])


def _cell(cell, canvas):
    schematic = cell.schematic
    lines = [f"  cell({cell.name}) {{", f"    area : {cell.drawing['width'] * canvas.height:.4f};"]
    function = dict(schematic.functions)
    if schematic.storage == "ff":
        clear = f' clear : "{function["clear"]}";' if "clear" in function else ""
        lines.append(f'    ff(IQ, IQN) {{ clocked_on : "clk"; next_state : "{function["next_state"]}";{clear} }}')
        function = {"q": "IQ"}
    if schematic.storage == "gate":
        lines.append("    clock_gating_integrated_cell : latch_posedge;")
        function = {}
    for pin in schematic.inputs:
        clock = " clock : true;" if pin == "clk" else ""
        lines.append(f"    pin({pin}) {{ direction : input;{clock} }}")
    for pin in schematic.outputs:
        text = f' function : "{function[pin]}";' if pin in function else ""
        lines.append(f"    pin({pin}) {{ direction : output;{text} }}")
    return [*lines, "  }"]
