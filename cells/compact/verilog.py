"""Verilog models of the cells, without delays: for gate-level simulation and equivalence."""

from collections.abc import Iterable

from talbot.cells.compact.transistors import Schematic

CONSTANTS = {"0": "1'b0", "1": "1'b1"}


def verilog(cells: Iterable[Schematic]) -> str:
    """Text for ``cells``: a module each, without supply pins."""
    return "\n".join(["// Compact cells; written by talbot cells-compact", *map(_module, cells)])


def _module(s: Schematic) -> str:
    ports = [*(f"input {pin}" for pin in s.inputs), *(f"output {pin}" for pin in s.outputs)]
    values = {pin: s.functions.get(pin, "") for pin in s.outputs}
    body = _storage(s) if s.storage else [f"  assign {pin} = {CONSTANTS.get(v, v)};" for pin, v in values.items()]
    return "\n".join([f"module {s.name} ({', '.join(ports)});", *body, "endmodule", ""])


def _storage(s: Schematic) -> list[str]:
    if s.storage == "gate":
        return ["  reg enable;", "  always @(clk or i) if (!clk) enable = i;", "  assign q = clk & enable;"]
    if "clear" in s.functions:
        body = f"    if (!nrst) state <= 1'b0; else state <= {s.functions['next_state']};"
        return ["  reg state;", "  always @(posedge clk or negedge nrst)", body, "  assign q = state;"]
    return ["  reg state;", f"  always @(posedge clk) state <= {s.functions['next_state']};", "  assign q = state;"]
