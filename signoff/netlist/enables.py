"""Clock gates turned back into enables: what a gated register does at an edge of the clock, where that can be proven.

A gate is a latch that is open while the clock is low, and the AND of latch and clock. Registers and inputs change at
the clock's rising edge alone. So the latch has its final value, the enable's, before that edge and keeps it while the
clock is high: the AND rises with the clock if the enable is 1, and not at all else. A register on it takes its data if
the enable is 1, and keeps what it has else.
"""

from typing import Any

from talbot.base.steps import StepError

REGISTER, LATCHES = "$_DFF_P_", {"$_DLATCH_P_": True, "$_DLATCH_N_": False}  # open at 1, at 0
COPIES = {"$_BUF_": False, "$_NOT_": True}  # whether inverting
Cells = dict[str, dict[str, Any]]  # of Yosys's JSON, by name


def with_enables(cells: Cells, clock: int) -> Cells:
    """The cells with every gated register on ``clock`` (its bit), behind a multiplexer that its enable selects.

    Raises StepError where a register's clock is something else, or where a clock or a latch drives other cells.
    """
    drivers = {pins_of(cell)[out]: (name, cell) for name, cell in cells.items() for out in "YQ" if out in pins_of(cell)}
    made, gone = dict(cells), set()
    new = 1 + max(
        (bit for cell in cells.values() for bit in pins_of(cell).values() if isinstance(bit, int)), default=clock
    )

    def source(bit: Any) -> tuple[Any, bool, list[str]]:
        """(bit, whether inverted, cells between) that ``bit`` is a copy of."""
        inverted, between = False, []
        while bit in drivers and drivers[bit][1]["type"] in COPIES:
            name, cell = drivers[bit]
            between.append(name)
            inverted, bit = inverted ^ COPIES[cell["type"]], pins_of(cell)["A"]
        return bit, inverted, between

    def enable(name: str, bit: Any) -> Any:
        """The enable of register ``name`` whose clock is ``bit``, None where that is the clock itself."""
        root, inverted, between = source(bit)
        gone.update(between)
        if (root, inverted) == (clock, False):
            return None
        gate, cell = drivers.get(root, ("", {"type": ""}))
        if inverted or cell["type"] != "$_AND_":
            raise StepError(f"equivalence: flip-flop {name} is neither on the clock's rising edge nor behind a gate")
        for one, other in ("AB", "BA"):
            of_clock, of_latch = source(pins_of(cell)[one]), source(pins_of(cell)[other])
            latch, held = drivers.get(of_latch[0], ("", {"type": ""}))
            if of_clock[:2] == (clock, False) and not of_latch[1] and held["type"] in LATCHES:
                open_at = source(pins_of(held)["E"])
                if open_at[:2] == (clock, LATCHES[held["type"]]):
                    gone.update((gate, latch), *(path[2] for path in (of_clock, of_latch, open_at)))
                    return pins_of(held)["D"]
        raise StepError(f"equivalence: the clock of flip-flop {name} is no gate with a latch that is open at 0")

    for name, cell in cells.items():
        if cell["type"] == REGISTER:
            own = pins_of(cell)
            selected = enable(name, own["C"])
            if selected is not None:
                made[f"{name}$enable"] = simple("$_MUX_", A=own["Q"], B=own["D"], S=selected, Y=new)
                own, new = own | {"D": new}, new + 1
            made[name] = simple(REGISTER, **own | {"C": clock})
    clocks = {clock} | {bit for bit, (name, _) in drivers.items() if name in gone}
    made = {name: cell for name, cell in made.items() if name not in gone}
    for name, cell in made.items():
        used = {bit for pin, bit in pins_of(cell).items() if (cell["type"], pin) != (REGISTER, "C")}
        if clocks & used or cell["type"] in LATCHES:
            raise StepError(f"equivalence: {name} is a latch, or has a clock or the latch of a clock gate as data")
    return made


def pins_of(cell: dict[str, Any]) -> dict[str, Any]:
    """Bit by pin of a simple cell."""
    return {pin: bits[0] for pin, bits in cell["connections"].items()}


def simple(kind: str, **connections: Any) -> dict[str, Any]:
    """A simple cell of Yosys's JSON: its type, and its bit by pin."""
    return {"type": kind, "connections": {pin: [bit] for pin, bit in connections.items()}}
