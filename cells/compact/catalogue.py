"""The cells: names, functions and transistors. Ports are named as in c4m-flexcell (i0, cmd, q, nq, clk, nrst)."""

from collections.abc import Iterator
from dataclasses import replace
from itertools import islice

from talbot.cells.compact.transistors import Function, Schematic, Switch
from talbot.platforms.twins import TWIN

INPUTS = ("i0", "i1", "i2", "i3", "i4")
# Cells that have a twin with high-threshold p transistors: those with most of a layout's leakage, but for the clock's
HIGH = (
    *("inv_x1", "buf_x1", "nand2_x1", "nand3_x1", "nor2_x1", "and21nor_x1", "or21nand_x1", "and22nor_x1"),
    *("or22nand_x1", "dff_x1"),
)


def schematics() -> dict[str, Schematic]:
    """Every cell with transistors, by name."""
    families = (_inverters, _simple, _complex, _exclusive, _arithmetic, _flip_flops, _clock_gates, _constants)
    return {schematic.name: schematic for family in families for schematic in family()}


def named(name: str) -> Schematic:
    """Return the cell ``name``, which may be a twin with high-threshold p transistors."""
    schematic = schematics()[name.removesuffix(TWIN)]
    return replace(schematic, name=name, high=True) if name.endswith(TWIN) else schematic


def _inverters() -> Iterator[Schematic]:
    for drive in (1, 2, 4, 8):
        yield Schematic(f"inv_x{drive}", ("i",), ("nq",)).gate("nq", "i", drive)
        first = {1: 1, 2: 1, 4: 2, 8: 3}[drive]
        yield Schematic(f"buf_x{drive}", ("i",), ("q",)).gate("n", "i", first).gate("q", "n", drive)


def _constants() -> Iterator[Schematic]:
    """Each transistor's gate hangs on the other's drain, never on a rail: no gate oxide sees the supply's edges."""
    for name, level, low, high in (("zero", "0", "zero", "h"), ("one", "1", "l", "one")):
        cell = Schematic(f"{name}_x1", (), (name,), functions={name: level})
        cell.n.append(Switch("n", high, low, "vss"))
        cell.p.append(Switch("p", low, high, "vdd"))
        yield cell


def _simple() -> Iterator[Schematic]:
    for count in (2, 3, 4):
        ports = INPUTS[:count]
        variants = [(operator, drive) for operator in ("and", "or") for drive in ((1, 2) if count == 2 else (1,))]
        for operator, drive in variants:
            yield Schematic(f"n{operator}{count}_x{drive}", ports, ("nq",)).gate("nq", (operator, *ports), drive)
        for operator, drive in variants:
            schematic = Schematic(f"{operator}{count}_x{drive}", ports, ("q",)).gate("n", (operator, *ports))
            yield schematic.gate("q", "n", drive)
    # One input inverted inside: nand2b = not (not i0 and i1)
    yield Schematic("nand2b_x1", ("i0", "i1"), ("nq",)).gate("n", "i0").gate("nq", ("and", "n", "i1"))
    yield Schematic("nor2b_x1", ("i0", "i1"), ("nq",)).gate("n", "i0").gate("nq", ("or", "n", "i1"))


def _complex() -> Iterator[Schematic]:
    """Yield complex gates: digits of a name are groups of inputs under its first operator; the second joins them."""
    functions: dict[str, Function] = {}
    for digits in ("21", "22", "211", "31", "221"):
        for inner, outer in (("and", "or"), ("or", "and")):
            pins = iter(INPUTS)
            groups = [list(islice(pins, int(digit))) for digit in digits]
            name, ports = f"{inner}{digits}n{outer}", INPUTS[: sum(map(len, groups))]
            functions[name] = (outer, *((inner, *group) if len(group) > 1 else group[0] for group in groups))
            yield Schematic(f"{name}_x1", ports, ("nq",)).gate("nq", functions[name])
    pairs = {"and21or": "and21nor", "or21and": "or21nand", "and22or": "and22nor", "or22and": "or22nand"}
    for name, inverting in pairs.items():
        ports = INPUTS[: 3 if "21" in name else 4]
        yield Schematic(f"{name}_x1", ports, ("q",)).gate("n", functions[inverting]).gate("q", "n")


def _exclusive() -> Iterator[Schematic]:
    xor = Schematic("xor2_x1", ("i0", "i1"), ("q",)).gate("n", ("or", "i0", "i1"))
    yield xor.gate("q", ("or", ("and", "i0", "i1"), "n"))
    nexor = Schematic("nexor2_x1", ("i0", "i1"), ("nq",)).gate("n", ("and", "i0", "i1"))
    yield nexor.gate("nq", ("and", ("or", "i0", "i1"), "n"))
    for name, output in (("mux2_x1", "q"), ("nmux2_x1", "nq")):
        mux = Schematic(name, ("cmd", "i0", "i1"), (output,)).gate("c", "cmd")
        inner = "n" if output == "q" else output
        mux.inverting_tristate(inner, "i1", "cmd", "c").inverting_tristate(inner, "i0", "c", "cmd")
        mux.functions[inner] = "!((cmd & i1) | (!cmd & i0))"
        yield mux.gate("q", "n") if output == "q" else mux


def _arithmetic() -> Iterator[Schematic]:
    half = Schematic("ha_x1", ("i0", "i1"), ("sum", "carry")).gate("n", ("and", "i0", "i1")).gate("carry", "n")
    yield half.gate("x", ("and", ("or", "i0", "i1"), "n")).gate("sum", "x")
    majority = ("or", ("and", "i0", "i1"), ("and", "i2", ("or", "i0", "i1")))
    full = Schematic("fa_x1", ("i0", "i1", "i2"), ("sum", "carry")).gate("n", majority).gate("carry", "n")
    yield full.gate("x", ("or", ("and", "i0", "i1", "i2"), ("and", "n", ("or", "i0", "i1", "i2")))).gate("sum", "x")


def _flip_flops() -> Iterator[Schematic]:
    """Master and slave of pass gates and clocked feedback, as SkyWater's dfxtp and dfrtp."""
    for drive in (1, 2):
        schematic = _stored(Schematic(f"dff_x{drive}", ("i", "clk"), ("q",))).gate("a", "m")
        schematic.inverting_tristate("m", "a", "cb", "cn").pass_gate("a", "s", "cb", "cn")
        schematic.gate("b", "s").inverting_tristate("s", "b", "cn", "cb").gate("q", "b", drive)
        yield _sequential(schematic, "ff", next_state="i")
        schematic = _stored(Schematic(f"dffnr_x{drive}", ("i", "clk", "nrst"), ("q",))).gate("a", "m")
        schematic.inverting_tristate("m", "a", "cb", "cn", reset="nrst").pass_gate("a", "s", "cb", "cn")
        schematic.gate("b", ("and", "s", "nrst")).inverting_tristate("s", "b", "cn", "cb").gate("q", "b", drive)
        yield _sequential(schematic, "ff", next_state="i", clear="!nrst")


def _clock_gates() -> Iterator[Schematic]:
    """q = clk while the enable, held from before the clock rises, is high."""
    for drive in (1, 2):
        schematic = _stored(Schematic(f"cg_x{drive}", ("i", "clk"), ("q",))).gate("a", "m")
        schematic.inverting_tristate("m", "a", "cb", "cn").gate("n", ("and", "a", "clk")).gate("q", "n", drive)
        yield _sequential(schematic, "gate")


def _stored(schematic: Schematic) -> Schematic:
    """Add both phases of the clock, cn = not clk and cb = clk, and m = not i while the clock is low."""
    return schematic.gate("cn", "clk").gate("cb", "cn").gate("d", "i").pass_gate("d", "m", "cn", "cb")


def _sequential(schematic: Schematic, storage: str, **functions: str) -> Schematic:
    schematic.storage, schematic.functions = storage, functions
    return schematic
