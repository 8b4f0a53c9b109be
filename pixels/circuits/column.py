"""A column in transistors: both diodes of the row that is read, charge to voltage, doubled, held, and onto a lane.

    column_a --+--| >--+-- Cin -- enter --+--| >--+-- out     of each diode; Cin = 2 Chold
               +-- Cf -+                  x       own
               +-clear-+                  +--Chold-- f -+-- onto -- sense, the far end of lane_a
                                                |
                                                +-- start

    read    |_|‾‾‾‾‾‾‾‾‾‾‾|‾‾‾‾‾‾‾‾‾‾‾|________________
    clear   |_|‾‾‾‾‾‾‾|________________________________      the charge amplifier is reset
    ref     |_|‾‾‾‾‾‾‾‾‾‾‾|____________________________      the holder is reset, Chold is from x to start, as f is
    sig     |_____________|‾‾‾‾‾‾‾‾‾‾‾|________________      the row's wells are at the lines, the holder follows
    sel     |_____________________________|‾‾|_________      its column's turn: it drives the lane

The charge amplifier raises its output by what the well had lost, Cf being the well's size. The holder falls by twice
that; reset noise, charge and offset of what was before the signal half are taken off. What Chold has as it ends stays
until the column's turn. Then the holder's transistor drives the lane through a separate cascode, with the lane's
source of current (`lane_end`) and Chold alone as its feedback: lane = dark - 2 (the well's fall). It is the transistor
that the holder was reset to: its threshold is in no sample. Its gate is higher then, by a hundred times the current: a
capacitor from x to what rises to start (`kick`) brings that, or the holder would have to reach below ground. start and
start_a, of the second and the first diode, are trimmed until a column without light is at the lanes' reference.
Without the gate of its cascodes, cn, a column takes no current.

In the modes with codes 0..255 (edgen) a quarter of the first diode's Cin is at either charge amplifier's output and a
half at none: lane_a is dark - (a + b) / 2 then, and its reference a quarter of the swing below dark. In raw mode the
first diode's sample is in its tap 1: a turn takes charge of the samples that it joins, and each diode has a turn alone.
"""

from talbot.pixels.circuits.column_sizes import BACK_TOP, CASCODE, CASCODE_P, FRONT, LANE, TOP, ColumnSizes
from talbot.pixels.circuits.gates import LENGTH, inverter, nand, nor
from talbot.pixels.circuits.netlist import Capacitor, Circuit, Instance, Transistor

TAPS = 4
# Roles and lengths (um) of switches: regular n transistors do not conduct at half of 1.62 V
SWITCH, SWITCH_P, SLOW = ("n_lvt", LENGTH), ("p_lvt", 0.35), ("n_lvt", 1.0)
SUPPLIES = "vdd", "vss"
BIASES = "vbp", "vcp", "vcn", "vbl"  # lines of the bias
CONTROLS = ("clear", "reads", "cn", "ref", "sig", "sign", "edge", "edgen", "idle", "vcn", "vcnb")
OF_TAPS = tuple(f"{name}{t}" for name in ("w", "f", "fn", "unasked") for t in range(TAPS))
# Of those the first diode's second stage has separate lines: on all but start_a is the same, `reads` on `reads_a`
SHARED = ("reads", "cn", "ref", "sig", "sign", "idle", "vbp", "vcp", "level", "start", "w0", "f0", "fn0")
TWICE = tuple(f"{name}_a" for name in SHARED)
PINS = ("column_a", "column_b", "lane_a", "sense_a", "lane_b", "sense_b", "group", "k", *CONTROLS, *OF_TAPS)
PINS += ("vbp", "vcp", "level", "start", *TWICE, *SUPPLIES)


# Lines of the first diode's tap 0 that the block's bank drives apart: in raw mode its sample is in tap 1
APART = "w0_a", "f0_a", "fn0_a"


def line(pin: str) -> str:
    """Return the line on a pin, where both diodes have theirs in tap 0: `reads` on `reads_a`."""
    return pin.removesuffix("_a") if pin in TWICE and pin != "start_a" else pin


def block_line(pin: str) -> str:
    """Return the block's line on a pin of a column."""
    return pin if pin in APART else line(pin)


def n(name: str, nodes: str, w: float, kind: tuple[str, float]) -> Transistor:
    """Return an n transistor; nodes: drain gate source."""
    drain, gate, source = nodes.split()
    return Transistor(name, drain, gate, source, "vss", kind[0], w, kind[1])


def p(name: str, nodes: str, w: float, kind: tuple[str, float]) -> Transistor:
    """Return a p transistor; nodes: drain gate source."""
    drain, gate, source = nodes.split()
    return Transistor(name, drain, gate, source, "vdd", kind[0], w, kind[1])


def source(name: str, nodes: str, w: float, kind: tuple[str, float], parts: int = 1) -> Transistor:
    """Return a p transistor as a current source of ``parts`` times the bias's."""
    return p(name, nodes, w, kind)._replace(fingers=parts)


def _through(name: str, a: str, b: str, on: str, off: str, w: float = 0.42) -> tuple[Transistor, Transistor]:
    """Return a switch of both kinds."""
    return n(f"{name}_n", f"{a} {on} {b}", w, SWITCH), p(f"{name}_p", f"{a} {off} {b}", 2 * w, SWITCH_P)


def charge_amplifier(sizes: ColumnSizes) -> Circuit:
    """Pins line out clear cn vbp vcp vdd vss."""
    stage = sizes.front
    return Circuit(
        "charge_amplifier",
        ("line", "out", "clear", "cn", "vbp", "vcp", *SUPPLIES),
        (
            n("in", "below line vss", stage.input, FRONT),
            n("cascode", "out cn below", stage.cascode, CASCODE),
            source("top", "above vbp vdd", stage.top, TOP),
            p("cascode_p", "out vcp above", stage.cascode_p, CASCODE_P),
            n("clear", "line clear out", 0.42, SWITCH),
        ),
        (Capacitor("f", "line", "out", sizes.feedback, 1),),
    )


def tap(sizes: ColumnSizes) -> Circuit:
    """Return a capacitor that holds, and its switches. Pins x f w s o on start vdd vss.

    w: it is at x while its row is read; s: in its column's turn. o: its far end is at f, else at start.
    """
    return Circuit(
        "tap",
        ("x", "f", "w", "s", "o", "on", "start", *SUPPLIES),
        (
            n("write", "x w inner", 0.42, SWITCH),
            n("join", "x s inner", 0.84, SWITCH),
            *_through("far", "outer", "f", "o", "on", 0.84),
            p("rest", "outer o start", 0.84, SWITCH_P),
        ),
        (Capacitor("hold", "inner", "outer", sizes.hold, 1),),
    )


def holder(sizes: ColumnSizes, taps: int) -> Circuit:
    """Return the second stage without Cin; w0 s0 o0 on0 and so on are of each tap.

    go: the gate of the lane's cascode, vcn while the column is selected, else 0.
    """
    back, lane = sizes.back, sizes.lane
    of_taps = tuple(f"{name}{t}" for t in range(taps) for name in ("w", "s", "o", "on"))
    return Circuit(
        f"holder{taps}",
        ("cin", "lane", "sense", "go", "sel", "seln", "idle", "reads", "ref", "sig", "sign", *of_taps)
        + ("cn", "vbp", "vcp", "level", "start", *SUPPLIES),
        (
            n("enter", "cin reads x", 0.84, SWITCH),
            n("in", "below x vss", lane.input, LANE),
            n("cascode", "out cn below", back.cascode, CASCODE),
            source("top", "above vbp vdd", back.top, BACK_TOP),
            p("cascode_p", "out vcp above", back.cascode_p, CASCODE_P),
            n("drive", "lane go below", lane.cascode, CASCODE),
            n("reset", "x ref out", 0.42, SLOW),
            n("tie", "x idle level", 0.42, SWITCH),
            n("low", "kick seln vss", 0.42, SWITCH),
            p("high", "kick seln start", 0.84, SWITCH_P),
            *_through("own", "f", "out", "sig", "sign", 0.84),
            *_through("onto", "f", "sense", "sel", "seln", 1.68),
        ),
        (Capacitor("kick", "x", "kick", sizes.kick, 1),),
        instances=tuple(
            Instance(f"tap{t}", tap(sizes), ("x", "f", f"w{t}", f"s{t}", f"o{t}", f"on{t}", "start", *SUPPLIES))
            for t in range(taps)
        ),
    )


def column(sizes: ColumnSizes) -> Circuit:
    """Both diodes of a column, with its part of the decoder. Pins PINS."""
    cin = sizes.gain * sizes.hold
    parts = [
        Instance("select_n", nand(3), ("group", "k", "seln", *SUPPLIES)),
        Instance("select", inverter(4), ("seln", "sel", *SUPPLIES)),
        *(Instance(f"on{t}", nor(), ("seln", f"unasked{t}", f"s{t}", *SUPPLIES)) for t in range(TAPS)),
    ]
    for d, taps in (("a", TAPS), ("b", 1)):
        biased = "cn", "vbp", "vcp"
        parts.append(
            Instance(f"front_{d}", charge_amplifier(sizes), (f"column_{d}", f"out_{d}", "clear", *biased, *SUPPLIES))
        )
        of_taps = (name for t in range(taps) for name in (f"w{t}", f"s{t}", f"f{t}", f"fn{t}"))
        nodes = "idle", "reads", "ref", "sig", "sign", *of_taps, *biased, "level", "start"
        pins = (f"{name}_a" if d == "a" and name in SHARED else name for name in nodes)
        ways = f"cin_{d}", f"lane_{d}", f"sense_{d}", f"go_{d}", "sel", "seln"
        parts.append(Instance(f"back_{d}", holder(sizes, taps), (*ways, *pins, *SUPPLIES)))
    switches = [
        n("go_a", "vcn sel go_a", 0.84, SWITCH),
        n("stop_a", "go_a seln vss", 0.42, SWITCH),
        n("go_b", "vcnb sel go_b", 0.84, SWITCH),
        n("stop_b", "go_b seln vss", 0.42, SWITCH),
        # A quarter of the first diode's Cin is at the second's in the modes of a sum, a half is at rest then
        *_through("quarter_a", "quarter", "out_a", "edge", "edgen"),
        *_through("quarter_b", "quarter", "out_b", "edgen", "edge"),
        *_through("half_a", "half", "out_a", "edge", "edgen"),
        n("half_rest", "half edgen vss", 0.42, SWITCH),
    ]
    capacitors = (
        Capacitor("in_b", "out_b", "cin_b", cin, 2),
        Capacitor("in_a", "out_a", "cin_a", cin / 4, 1),
        Capacitor("in_quarter", "quarter", "cin_a", cin / 4, 1),
        Capacitor("in_half", "half", "cin_a", cin / 2, 1),
    )
    return Circuit("column", PINS, tuple(switches), capacitors, instances=tuple(parts))
