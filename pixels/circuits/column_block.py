"""The shared circuits of a block of columns: bias, drivers of the lines to all columns, ends of the lanes' lines."""

from itertools import pairwise

from talbot.pixels.circuits.amplifier import BIAS
from talbot.pixels.circuits.column import (
    APART,
    BIASES,
    CONTROLS,
    OF_TAPS,
    SUPPLIES,
    SWITCH,
    SWITCH_P,
    TAPS,
    n,
    p,
    source,
)
from talbot.pixels.circuits.column_sizes import (
    CASCODE,
    CASCODE_P,
    FRONT,
    LANE_TOP,
    PARTS,
    TOP,
    ColumnSizes,
    ColumnSpec,
    drawn,
)
from talbot.pixels.circuits.gates import LENGTH, inverter, nand, nor
from talbot.pixels.circuits.netlist import Capacitor, Circuit, Instance, Resistor, Transistor
from talbot.pixels.circuits.row_driver import nand_of

POWER = ("p", LENGTH)
BRANCH = 1.25e-6  # A, of each branch of the bias
DECOUPLING = 5e-12  # F at each of its lines
# F outside of the chip at each, and at level: all columns' outputs end at once as a row ends, 10 fC each at vcp, and a
# fronts' offset of 20 uV of vbp is an LSB. What selected cascodes' gates take of vcn is lost: some uA
OUTSIDE = 100e-9
GATES = 2  # charge amplifiers' currents at vcn
STACK, STACK_P = (1.0, ("n_lvt", 5.0)), (0.42, ("p", 2.0))  # um, of the diodes that make the cascodes' gates
LEG = 0.8  # um, of a branch of the bias
SECTIONS = 12  # of a lane's line
GROUPS, PLACES = 8, 6  # lines of a group, of a place in the tile
CLEAR = 1.15e-6  # s in which the charge amplifiers are reset: until the second stages' capacitors are charged
LATE = 4  # inverters by which what must end last does
BANK_INPUTS = ("ref_ctl", "read", "tap0", "tap1", "mode0", "mode1", "hold")
BANK_INPUTS += tuple(f"{name}{bit}" for name, bits in (("group", 3), ("k", 3), ("sub", 2)) for bit in range(bits))
LINES = tuple(f"group_{g}" for g in range(GROUPS)) + tuple(f"k_{k}" for k in range(PLACES))
CASCODES = "cn", "vcn", "vcnb"  # lines that are not the bank's
BANK_OUTPUTS = (
    *(name for name in CONTROLS if name != "vcn"),
    *OF_TAPS,
    *APART,
    *LINES,
    "turn",
    "turnn",
    "turnb",
    "turnbn",
)


def column_bias(sizes: ColumnSizes) -> Circuit:
    """Lines of the bias to all columns and lanes, and the level to which wells are reset.

    Pins ibias BIASES level vdd vss. ibias: takes BIAS. level is of a replica of a charge amplifier.
    """
    front, lane = sizes.front, sizes.lane

    def feed(name: str, node: str, times: int = 1) -> tuple[Transistor, Transistor]:
        """So many charge amplifiers' currents into a node."""
        return (
            source(f"{name}_top", f"{name}_high vbp vdd", round(front.top * times, 2), TOP, times),
            p(f"{name}_cascode", f"{node} vcp {name}_high", drawn(front.cascode_p * times), CASCODE_P),
        )

    devices = [
        *(n(f"one{k}", "ibias ibias vss", LEG, FRONT) for k in range(round(BIAS / BRANCH))),
        n("leg_vbp", "vbp ibias vss", drawn(LEG * front.current / BRANCH), FRONT),
        n("leg_vcp", "vcp ibias vss", LEG, FRONT),
        n("leg_vbl", "vbl ibias vss", drawn(LEG * lane.current / PARTS / BRANCH), FRONT),
        *feed("vbp", "vbp"),
        source("vbl_top", "vbl_high vbl vdd", round(lane.top / PARTS, 2), LANE_TOP),
        source("vbl_cascode", "vbl vcp vbl_high", round(lane.cascode_p / PARTS, 2), CASCODE_P),
        p("vcp", "vcp vcp vdd", *STACK_P),
        *feed("vcn", "vcn", GATES),
        n("vcn", "vcn vcn vss", *STACK),
        *feed("level", "level"),
        n("level_in", "level_low level vss", front.input, FRONT),
        n("level_under", "level vcn level_low", front.cascode, CASCODE),
    ]
    lines = tuple(Capacitor(f"c_{name}", name, "vss" if name == "vcn" else "vdd", DECOUPLING, 1) for name in BIASES)
    return Circuit("column_bias", ("ibias", *BIASES, "level", *SUPPLIES), tuple(devices), lines)


def cascode_lines() -> Circuit:
    """Return the gates of the columns' cascodes: cn while a row is read, vcnb for what drives the second diode's lane.

    Pins vcn reads readsn edge edgen cn vcnb vss.
    """
    return Circuit(
        "cascode_lines",
        ("vcn", "reads", "readsn", "edge", "edgen", *(name for name in CASCODES if name != "vcn"), "vss"),
        tuple(
            n(name, nodes, 2.6, SWITCH)
            for name, nodes in {
                "read": "vcn reads cn",
                "unread": "cn readsn vss",
                "second": "vcn edge vcnb",
                "none": "vcnb edgen vss",
            }.items()
        ),
    )


def lane_end(sizes: ColumnSizes) -> Circuit:
    """Return the end of a lane's line: its current source in a turn, else its reference.

    Pins lane reference turn turnn vbl vcp vdd vss.
    """
    stage = sizes.lane
    return Circuit(
        "lane_end",
        ("lane", "reference", "turn", "turnn", "vbl", "vcp", *SUPPLIES),
        (
            p("on", "high turnn vdd", 10.4, POWER),
            source("top", "above vbl high", stage.top, LANE_TOP, PARTS),
            source("cascode_p", "lane vcp above", stage.cascode_p, CASCODE_P, PARTS),
            n("rest_n", "lane turnn reference", 6.0, SWITCH),
            p("rest_p", "lane turn reference", 12.0, SWITCH_P),
        ),
    )


def lane_line(sizes: ColumnSizes, spec: ColumnSpec) -> Circuit:
    """Return a lane's line with its other columns, none of which is selected, and the one that senses its far end.

    Pins near sense far vss. A selected column's feedback is from the far end: its current has a drop on the way there.
    """
    ohm, farad = spec.ohm / SECTIONS, spec.wire / SECTIONS
    w = round((spec.columns - 1) / SECTIONS * sizes.lane.cascode, 2)
    transistors, resistors, capacitors = [], [], []
    for name in ("near", "sense"):
        nodes = [name, *(f"{name}{k}" for k in range(1, SECTIONS)), "far"]
        for k, (a, b) in enumerate(pairwise(nodes)):
            middle = f"{name}_m{k}"
            resistors += [Resistor(f"{name}_a{k}", a, middle, ohm / 2), Resistor(f"{name}_b{k}", middle, b, ohm / 2)]
            capacitors.append(Capacitor(f"{name}{k}", middle, "vss", farad))
            if name == "near":
                transistors.append(n(f"others{k}", f"{middle} vss vss", w, CASCODE))
    return Circuit(
        "lane_line", ("near", "sense", "far", "vss"), tuple(transistors), tuple(capacitors), tuple(resistors)
    )


def clear_pulse(sizes: ColumnSizes) -> Circuit:
    """Return a pulse of some CLEAR from the begin of ref on, which a current through a capacitor ends.

    Pins ref refn clear vbp vdd vss.
    """
    # Half a charge amplifier's current, of less than half its width: narrow transistors have more
    width, farad = drawn(0.37 * sizes.front.top), CLEAR * sizes.front.current / 2 / 0.75
    return Circuit(
        "clear_pulse",
        ("ref", "refn", "clear", "vbp", *SUPPLIES),
        (p("charge", "ramp vbp vdd", width, TOP), n("stay", "ramp refn vss", 0.84, ("n", LENGTH))),
        (Capacitor("ramp", "ramp", "vss", farad, 1),),
        instances=(
            Instance("over", inverter(1, 2.0), ("ramp", "notyet", *SUPPLIES)),
            Instance("clear_n", nand(), ("ref", "notyet", "clearn", *SUPPLIES)),
            Instance("clear", inverter(6), ("clearn", "clear", *SUPPLIES)),
        ),
    )


def bank(sizes: ColumnSizes) -> Circuit:
    """Return the drivers of the lines that cross all columns. Pins BANK_INPUTS, BANK_OUTPUTS, vbp vcn vdd vss.

    A group's line is high in a turn alone. `clear` ends by itself: a current charges a capacitor from the row's start
    on. The holder's reset ends before the signal half begins, and its capacitors part from x before all else. While a
    row is read or a lane has its turn no x is tied. mode0: of the modes with sums; in the others, edge and raw, both
    diodes of a column drive their lanes. In raw mode the first diode's sample is in tap 1, the second's in tap 0, and
    each is joined in its sub-sample alone.
    """
    parts, count = list[Instance](), 0

    def gate(kind: Circuit, *nodes: str) -> str:
        nonlocal count
        count += 1
        parts.append(Instance(f"g{count}", kind, (*nodes, *SUPPLIES)))
        return nodes[-1]

    def late(node: str, name: str) -> str:
        """``node``, as many slow inverters later."""
        for k in range(LATE):
            node = gate(inverter(1, 0.5), node, f"{name}_late{k}")
        return node

    def longer(node: str, name: str, inverted: str = "") -> None:
        """A line that ends after ``node`` does."""
        both = gate(nor(), node, late(node, name), f"{name}_both")
        gate(inverter(6), both, name)
        if inverted:
            gate(inverter(6), name, inverted)

    def decoded(name: str, lines: int, bits: int, out: str, also: tuple[str, ...] = ()) -> None:
        for bit in range(bits):
            gate(inverter(2), f"{name}{bit}", f"{name}{bit}n")
        for code in range(lines):
            inputs = (f"{name}{bit}{'' if code >> bit & 1 else 'n'}" for bit in range(bits))
            gate(inverter(6), gate(nand_of(bits + len(also)), *inputs, *also, f"{out}{code}n"), f"{out}{code}")

    gate(inverter(6), gate(nand(), "read", "ref_ctl", "refn"), "ref")
    longer("read", "reads", "readsn")
    gate(inverter(), "read", "readn")
    gate(nor(), "readn", gate(inverter(), gate(nor(), "ref", late("ref", "after"), "noref"), "anyref"), "signal")
    longer("signal", "sig", "sign")
    parts.append(Instance("clear", clear_pulse(sizes), ("ref", "refn", "clear", "vbp", *SUPPLIES)))
    parts.append(Instance("cascodes", cascode_lines(), cascode_lines().ports))
    gate(inverter(6), gate(inverter(6), gate(inverter(), "mode0", "first"), "edgen"), "edge")
    decoded("tap", TAPS, 2, "now")
    longer("hold", "turned")
    gate(inverter(6), gate(inverter(), gate(nor(), "reads", "turned", "alone"), "idlen"), "idle")
    gate(inverter(2), gate(nand(), "mode1", "first", "rawn"), "raw")
    swapped = gate(nand(), "raw", gate(inverter(), "sub0", "subn"), "held0_r")
    gate(nand(2), gate(nand(), "sub0", "mode0", "held0_s"), swapped, "held0")
    gate(inverter(2), gate(nand(), "sub1", "mode0", "held1_"), "held1")
    decoded("held", TAPS, 2, "asked")
    gate(inverter(2), gate(nand(), "now0", "rawn", "now0_n"), "now0_a")
    gate(nand(2), gate(inverter(), "now1", "now1_n"), gate(nand(), "now0", "raw", "now1_r"), "now1_a")
    nows = {"0": "now0", "0_a": "now0_a", "1": "now1_a", "2": "now2", "3": "now3"}
    for name, now in nows.items():
        gate(inverter(6), gate(nand(), "read", now, f"wn{name}"), f"w{name}")
        ends = gate(nand(), "sig", now, f"fr{name}"), gate(nand(), "turned", f"asked{name[0]}", f"fs{name}")
        gate(inverter(6), gate(inverter(2), gate(nand(), *ends, f"fp{name}"), f"fq{name}"), f"f{name}")
        # In the reference half too: f is at start then, or what it had in the turn before were in the sample
        gate(inverter(6), gate(nand(2), f"fq{name}", f"wn{name}", f"fo{name}"), f"fn{name}")
    for t in range(TAPS):
        gate(inverter(6), f"asked{t}", f"unasked{t}")
    gate(inverter(6), gate(inverter(6), "hold", "turnn"), "turn")
    gate(inverter(6), gate(nand(6), "hold", "edge", "turnbn"), "turnb")
    decoded("group", GROUPS, 3, "group_", ("turn",))
    decoded("k", PLACES, 3, "k_")
    return Circuit("column_bank", (*BANK_INPUTS, *BANK_OUTPUTS, "vbp", "vcn", *SUPPLIES), instances=tuple(parts))


def band(sizes: ColumnSizes, lanes: int) -> Circuit:
    """Return the shared circuits of a block: bank, bias, the ends of the lanes' lines.

    Pins BANK_INPUTS, BANK_OUTPUTS, ibias BIASES level reference dark, lane_a0 lane_b0 and so on, vdd vss.
    """
    bank_circuit, end = bank(sizes), lane_end(sizes)
    parts = [
        Instance("bank", bank_circuit, bank_circuit.ports),
        Instance("bias", column_bias(sizes), ("ibias", *BIASES, "level", *SUPPLIES)),
    ]
    for lane in range(lanes):
        first = (f"lane_a{lane}", "reference", "turn", "turnn", "vbl", "vcp", *SUPPLIES)
        second = (f"lane_b{lane}", "dark", "turnb", "turnbn", "vbl", "vcp", *SUPPLIES)
        parts += [Instance(f"end_a{lane}", end, first), Instance(f"end_b{lane}", end, second)]
    lines = (f"lane_{d}{lane}" for lane in range(lanes) for d in "ab")
    pins = (*BANK_INPUTS, *BANK_OUTPUTS, "ibias", *BIASES, "level", "reference", "dark", *lines, *SUPPLIES)
    return Circuit("column_band", pins, instances=tuple(parts))


def taken(column: int, lanes: int, tile_cols: int = PLACES) -> tuple[int, dict[str, int]]:
    """Return the lane of a column, and the code of the line that it takes of each kind."""
    tile = column // tile_cols
    return tile % lanes, {"group": tile // lanes, "k": column % tile_cols}
