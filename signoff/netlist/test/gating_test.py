"""Clock gates and buffers: no more registers behind one than asked for, and each still on its own enable."""

from collections import Counter

import pytest

from talbot.signoff.netlist.gating import ClockCells, ClockGate, drive_registers
from talbot.signoff.netlist.netlist import Buffer, Instance, Netlist, Port

SIZES = [ClockCells(ClockGate(f"cg_{x}", "i", "clk", "q"), Buffer(f"buf_{x}", "i", "q")) for x in ("x1", "x2")]
PORTS = Port("clk", "input", 1), Port("d", "input", 1), Port("e", "input", 2)


def registers(groups):
    """A netlist of registers: groups[k] of them behind gate k with enable e[k], the last without one."""
    cells = [Instance(f"u{k}", "cg_x1", {"i": f"e[{k}]", "clk": "clk", "q": f"g{k}"}) for k in range(len(groups) - 1)]
    for k, count in enumerate(groups):
        clock = f"g{k}" if k < len(groups) - 1 else "clk"
        cells += [Instance(f"r{k}_{j}_reg", "dff_x1", {"clk": clock, "i": "d", "q": f"q{k}_{j}"}) for j in range(count)]
    return Netlist("Registers", PORTS, tuple(cells))


def enables(netlist):
    """Register -> the enable of its clock, None without one; its clock must come from ``clk`` through one cell."""
    drivers = {i.pins["q"]: i for i in netlist.instances if not i.cell.startswith("dff")}
    assert all(i.pins.get("clk", i.pins["i"]) == "clk" for i in drivers.values())
    found = {i.name: drivers[i.pins["clk"]] for i in netlist.instances if i.cell.startswith("dff")}
    return {name: i.pins["i"] if i.cell.startswith("cg") else None for name, i in found.items()}


@pytest.mark.parametrize("groups", [(3, 8, 5), (1, 9, 30), (40, 2, 1), (8, 16)])
def test_registers_keep_their_enable_and_share_cells(groups):
    made = drive_registers(registers(groups), {"west": ["clk", "d"], "east": ["e[0]", "e[1]"]}, "clk", SIZES, 8)
    last = len(groups) - 1
    assert enables(made) == {
        f"r{k}_{j}_reg": f"e[{k}]" if k < last else None for k, count in enumerate(groups) for j in range(count)
    }
    loads = Counter(i.pins["clk"] for i in made.instances if i.cell.startswith("dff"))
    assert max(loads.values()) <= 8 and len(loads) == sum(-(-count // 8) for count in groups)
    for instance in made.instances:
        if not instance.cell.startswith("dff"):
            assert instance.cell.endswith("x1" if loads[instance.pins["q"]] <= 4 else "x2")
    names = [i.name for i in made.instances]
    assert len(set(names)) == len(names)
