"""Verilog models of the cells: functions, no delays; what gate-level simulation and equivalence read."""


def verilog(cells):
    """Text for ``cells`` (cells.compact.pdk.DrawnCell): a module each, without supply pins."""
    return "\n".join(["// Compact cells; written by talbot cells-compact", *(module(cell.schematic) for cell in cells)])


def module(schematic):
    """The model of one cell."""
    s = schematic
    ports = [*(f"input {pin}" for pin in s.inputs), *(f"output {pin}" for pin in s.outputs)]
    body = _storage(s) if s.storage else [f"  assign {pin} = {_constant(s.functions[pin])};" for pin in s.outputs]
    return "\n".join([f"module {s.name} ({', '.join(ports)});", *body, "endmodule", ""])


def _constant(function):
    return {"0": "1'b0", "1": "1'b1"}.get(function, function)


def _storage(s):
    if s.storage == "gate":
        return ["  reg enable;", "  always @(clk or i) if (!clk) enable = i;", "  assign q = clk & enable;"]
    if "clear" in s.functions:
        return [
            "  reg state;",
            "  always @(posedge clk or negedge nrst)",
            f"    if (!nrst) state <= 1'b0; else state <= {s.functions['next_state']};",
            "  assign q = state;",
        ]
    return ["  reg state;", f"  always @(posedge clk) state <= {s.functions['next_state']};", "  assign q = state;"]
