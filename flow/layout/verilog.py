"""A user's Verilog as a Design: read by Yosys before anything is laid out."""

import json
import re
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from talbot.base.tools import ToolError, run
from talbot.flow.layout.design import DESIGNS, Clock, Design
from talbot.models.parameters import ParameterError

INCLUDE = re.compile(r'[ \t]*`include[ \t]+"([^"]+)"')
READ = """
read_verilog -sv design.sv
hierarchy -check -top {top}
proc
flatten
memory -nordff
opt_clean
write_json design.json
"""
REGISTERS = "$dff", "$dffe", "$sdff", "$sdffe", "$sdffce"  # flip-flops without asynchronous inputs


def design_of(files: Sequence[Path], top: str, clock: str = "clk", reset: str = "", period_ns: float = 20.0) -> Design:
    """The Design of the module ``top`` in Verilog ``files``.

    clock: its input, whose rising edge alone registers take. reset: its synchronous reset, active at 0 if the name ends
    in _n; '' for none. Raises ParameterError for files that are not there or that cannot be read, and for a module
    without these ports, with latches, asynchronous resets or falling edges.
    """
    if not re.fullmatch(r"[A-Za-z_]\w*", top):
        raise ParameterError(f"top = {top!r}: must be the name of a module")
    text = verilog_text(files)
    with tempfile.TemporaryDirectory(prefix="talbot-") as name:
        folder = Path(name)
        (folder / "design.sv").write_text(text, encoding="utf-8")
        try:
            run(["yosys", "-q", "-p", "; ".join(READ.format(top=top).split("\n"))], cwd=folder)
        except ToolError as error:
            found = re.search(r"(\S+:\d+: )?ERROR: (.*)", str(error))
            place, what = found.groups() if found else ("", str(error))
            raise ParameterError(f"verilog = {place or f'{files[0]}: '}{what}") from None
        module = json.loads((folder / "design.json").read_text(encoding="utf-8"))["modules"][top]
    check(module, files[0], clock, reset)
    taken = top in DESIGNS
    return Design(
        f"{top}_verilog" if taken else top, top, "", clock=Clock(clock, period_ns), reset=reset, verilog=tuple(files)
    )


def verilog_text(files: Sequence[Path]) -> str:
    """The text of all ``files``, those that they include in place. Raises ParameterError for one that is not there."""
    return "\n".join(_text(path, ()) for path in files)


def _text(path: Path, above: tuple[Path, ...]) -> str:
    if not path.is_file():
        raise ParameterError(f"verilog = {path}: no such file")
    if path in above:
        raise ParameterError(f"verilog = {path}: must not include itself")
    try:
        text = path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError:
        raise ParameterError(f"verilog = {path}: must be text in UTF-8") from None
    lines = []
    for number, line in enumerate(text.splitlines(), 1):
        include = INCLUDE.match(line)
        lines += [_text(path.parent / include[1], (*above, path)), _line(number + 1, path)] if include else [line]
    return "\n".join([_line(1, path), *lines, ""])


def _line(number: int, path: Path) -> str:
    """The directive by which tools name the place of an error in ``path``."""
    return f'`line {number} "{path}" 0'


def check(module: dict[str, Any], file: Path, clock: str, reset: str) -> None:
    """Raise ParameterError unless ``module`` (of Yosys's JSON) has the ports and can be laid out."""
    ports = module["ports"]
    for field, name in {"clock": clock, "reset": reset}.items():
        if name or field == "clock":
            fits = [each for each, port in ports.items() if port["direction"] == "input" and len(port["bits"]) == 1]
            if name not in fits:
                raise ParameterError(f"{field} = {name!r}: must be an input of one bit: {', '.join(fits) or 'none'}")
    if found := [name for name, port in ports.items() if port["direction"] == "inout"]:
        raise ParameterError(f"verilog = {file}: must have inputs and outputs alone: {found[0]} is inout")
    bit = ports[clock]["bits"][0]
    for name, cell in module["cells"].items():
        if "CLK" in cell["connections"] or "latch" in cell["type"] or "dff" in cell["type"]:
            where = f"{cell['attributes'].get('src', name)} is a {cell['type'].strip('$')}"
            if cell["type"] not in REGISTERS:
                raise ParameterError(f"verilog = {file}: must have flip-flops with synchronous resets alone: {where}")
            edge = int(cell["parameters"]["CLK_POLARITY"], 2)
            if cell["connections"]["CLK"] != [bit] or edge != 1:
                raise ParameterError(f"verilog = {file}: must take the rising edge of {clock} alone: {where}")
