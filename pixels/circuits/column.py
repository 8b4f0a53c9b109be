"""A column in transistors: both diodes of the row that is read, charge to voltage, doubled, held, and onto a lane.

    column_a --+--| >--+-- Cin --+--| >--+-- out            of each diode; Cin = 2 Chold
               +-- Cf -+         x       |
               +-clear-+         +--s-- Chold --s-- f --+-- sig -- out
                                         |              +-- sel -- sense, the far end of lane_a
                                         +-- start

    read    |_|‾‾‾‾‾‾‾‾‾‾‾|‾‾‾‾‾‾‾‾‾‾‾|________________
    clear   |_|‾‾‾|____________________________________      the charge amplifier is reset
    ref     |_|‾‾‾‾‾‾‾‾‾‾‾|____________________________      the holder is reset, Chold is from vx to start
    sig     |_____________|‾‾‾‾‾‾‾‾‾‾‾|________________      the row's wells are at the lines, the holder follows
    sel     |_____________________________|‾‾|_________      its column's turn: it drives the lane

The charge amplifier raises its output by what the well had lost, Cf being the well's size. The holder falls by twice
that; reset noise, charge and offset of what was before the signal half are taken off. What Chold has as it ends stays
until the column's turn. Then a transistor of the holder's input drives the lane, with the lane's own source of current
(`lane_end`) and Chold alone as its feedback: lane = dark - 2 (the well's fall). `start` is trimmed until a column
without light is at the lanes' reference. Out of its turn a column takes no current, and x is tied to vx, where it is in
its turn.

In the modes with codes 0..255 (edgen) a quarter of the first diode's Cin is at either charge amplifier's output and a
half at none: lane_a is dark - (a + b) / 2 then, and its reference a quarter of the swing below dark.
"""

from .amplifier import UNIT as CELL
from .column_sizes import BACK, CASCODE, CASCODE_P, FRONT, LANE, PARTS, TOP, ColumnSizes
from .gates import LENGTH, inverter, nand, nor
from .netlist import Capacitor, Circuit, Instance, Transistor

TAPS = 4
# Roles and lengths (um) of switches: regular n transistors do not conduct at half of 1.62 V
SWITCH, SWITCH_P, SLOW, POWER = ("n_lvt", LENGTH), ("p_lvt", 0.35), ("n_lvt", 1.0), ("p", LENGTH)
SUPPLIES = "vdd", "vss"
BIASES = "vbp", "vcp", "vcn", "vx", "vbl"  # lines of the bias to all columns
CONTROLS = ("clear", "reads", "readsn", "ref", "sig", "sign", "edge", "edgen")
OF_TAPS = tuple(f"{name}{t}" for name in ("r", "wn", "asked") for t in range(TAPS))
PINS = ("column_a", "column_b", "lane_a", "sense_a", "lane_b", "sense_b", "group", "k", *CONTROLS, *OF_TAPS)
PINS += (*BIASES, "start", *SUPPLIES)


def n(name: str, nodes: str, w: float, kind: tuple[str, float]) -> Transistor:
    """An n transistor; nodes: drain gate source."""
    drain, gate, source = nodes.split()
    return Transistor(name, drain, gate, source, "vss", kind[0], w, kind[1])


def p(name: str, nodes: str, w: float, kind: tuple[str, float]) -> Transistor:
    """A p transistor; nodes: drain gate source."""
    drain, gate, source = nodes.split()
    return Transistor(name, drain, gate, source, "vdd", kind[0], w, kind[1])


def _through(name: str, a: str, b: str, on: str, off: str, w: float = 0.42) -> tuple[Transistor, Transistor]:
    """A switch of both kinds."""
    return n(f"{name}_n", f"{a} {on} {b}", w, SWITCH), p(f"{name}_p", f"{a} {off} {b}", 2 * w, SWITCH_P)


def charge_amplifier(sizes: ColumnSizes) -> Circuit:
    """Pins line out clear on vbp vcp vcn vdd vss; on: its supply, where it is switched."""
    one = sizes.front
    return Circuit(
        "charge_amplifier",
        ("line", "out", "clear", "on", "vbp", "vcp", "vcn", *SUPPLIES),
        (
            n("in", "below line vss", one.input, FRONT),
            n("cascode", "out vcn below", one.cascode, CASCODE),
            p("top", "above vbp on", one.top, TOP),
            p("cascode_p", "out vcp above", one.cascode_p, CASCODE_P),
            n("clear", "line clear out", 0.42, SWITCH),
        ),
        (Capacitor("f", "line", "out", sizes.feedback, max(1, round(sizes.feedback / CELL))),),
    )


def tap(sizes: ColumnSizes) -> Circuit:
    """A capacitor that holds, and its switches. Pins x f s sn r vx dark vdd vss.

    s: it is between x and f, else its far end is at dark, where the near one is at vx (r) or above: nothing leaks.
    """
    return Circuit(
        "tap",
        ("x", "f", "s", "sn", "r", "vx", "start", *SUPPLIES),
        (
            n("join", "x s inner", 1.26, SWITCH),
            n("from_vx", "inner r vx", 0.42, SWITCH),
            *_through("far", "outer", "f", "s", "sn", 1.68),
            *_through("rest", "outer", "start", "sn", "s"),
        ),
        (Capacitor("hold", "inner", "outer", sizes.hold, round(sizes.hold / CELL)),),
    )


def holder(sizes: ColumnSizes, taps: int) -> Circuit:
    """The second stage without Cin; s0 sn0 r0 and so on are of each tap.

    go: the cascode's gate, vcn while the column is selected, else 0.
    """
    back, lane = sizes.back, sizes.lane
    of_taps = tuple(f"{name}{t}" for t in range(taps) for name in ("s", "sn", "r"))
    return Circuit(
        f"holder{taps}",
        ("cin", "lane", "sense", "go", "sel", "seln", "idle", "ref", "sig", "sign", *of_taps)
        + ("on", "vbp", "vcp", "vcn", "vx", "start", *SUPPLIES),
        (
            n("enter", "cin seln x", 0.84, SWITCH),
            n("in", "below x vss", back.input, BACK),
            n("cascode", "out vcn below", back.cascode, CASCODE),
            p("top", "above vbp on", back.top, TOP),
            p("cascode_p", "out vcp above", back.cascode_p, CASCODE_P),
            *(n(f"drive_in{k}", "under x vss", lane.input / PARTS, LANE) for k in range(PARTS)),
            n("drive", "lane go under", lane.cascode, CASCODE),
            n("reset", "x ref out", 0.42, SLOW),
            n("tie", "x idle vx", 0.42, SWITCH),
            *_through("own", "f", "out", "sig", "sign", 0.84),
            *_through("onto", "f", "sense", "sel", "seln", 2.4),
        ),
        instances=tuple(
            Instance(f"tap{t}", tap(sizes), ("x", "f", f"s{t}", f"sn{t}", f"r{t}", "vx", "start", *SUPPLIES))
            for t in range(taps)
        ),
    )


def column(sizes: ColumnSizes) -> Circuit:
    """Both diodes of a column, with its part of the decoder. Pins PINS."""
    cin = sizes.gain * sizes.hold
    units = round(cin / CELL)
    parts = [
        Instance("select_n", nand(), ("group", "k", "seln", *SUPPLIES)),
        Instance("select", inverter(4), ("seln", "sel", *SUPPLIES)),
        Instance("second_n", nand(), ("sel", "edge", "selbn", *SUPPLIES)),
        Instance("second", inverter(2), ("selbn", "selb", *SUPPLIES)),
        Instance("late_n", inverter(1, 0.5), ("sel", "laten", *SUPPLIES)),
        Instance("late", inverter(1, 0.5), ("laten", "late", *SUPPLIES)),
        Instance("quiet", nor(), ("reads", "late", "quiet", *SUPPLIES)),
        Instance("busy", inverter(), ("quiet", "busy", *SUPPLIES)),
        Instance("idle", nor(), ("sel", "busy", "idle", *SUPPLIES)),
    ]
    for t in range(TAPS):
        parts += [
            Instance(f"asked{t}_n", nand(), ("sel", f"asked{t}", f"unasked{t}", *SUPPLIES)),
            Instance(f"on{t}", nand(), (f"unasked{t}", f"wn{t}", f"s{t}", *SUPPLIES)),
            Instance(f"off{t}", inverter(), (f"s{t}", f"sn{t}", *SUPPLIES)),
        ]
    biased = "on", "vbp", "vcp", "cn"
    for d, taps in (("a", TAPS), ("b", 1)):
        parts.append(
            Instance(f"front_{d}", charge_amplifier(sizes), (f"column_{d}", f"out_{d}", "clear", *biased, *SUPPLIES))
        )
        select = ("sel", "seln") if d == "a" else ("selb", "selbn")
        of_taps = (f"{name}{t}" for t in range(taps) for name in ("s", "sn", "r"))
        parts.append(
            Instance(
                f"back_{d}",
                holder(sizes, taps),
                (f"cin_{d}", f"lane_{d}", f"sense_{d}", f"go_{d}", *select, "idle", "ref", "sig", "sign", *of_taps)
                + (*biased, "vx", "start", *SUPPLIES),
            )
        )
    switches = [
        p("power", "on readsn vdd", 4.0, POWER),
        n("under", "vcn reads cn", 0.84, SWITCH),
        n("stop", "cn readsn vss", 0.42, SWITCH),
        n("go_a", "vcn sel go_a", 0.84, SWITCH),
        n("stop_a", "go_a seln vss", 0.42, SWITCH),
        n("go_b", "vcn selb go_b", 0.84, SWITCH),
        n("stop_b", "go_b selbn vss", 0.42, SWITCH),
        # A quarter of the first diode's Cin is at the second's in the modes of a sum, a half is at rest then
        *_through("quarter_a", "quarter", "out_a", "edge", "edgen"),
        *_through("quarter_b", "quarter", "out_b", "edgen", "edge"),
        *_through("half_a", "half", "out_a", "edge", "edgen"),
        n("half_rest", "half edgen vss", 0.42, SWITCH),
    ]
    capacitors = (
        Capacitor("in_b", "out_b", "cin_b", cin, units),
        Capacitor("in_a", "out_a", "cin_a", cin / 4, units // 4),
        Capacitor("in_quarter", "quarter", "cin_a", cin / 4, units // 4),
        Capacitor("in_half", "half", "cin_a", cin / 2, units // 2),
    )
    return Circuit("column", PINS, tuple(switches), capacitors, instances=tuple(parts))
