"""The parts of a column from the west: strips of transistors, the rows of their nets, capacitors between the strips."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

from talbot.pixels.circuits.column import TAPS

# um
HEIGHT = 10.0  # of a column: a larger pitch leaves room between columns
PLATE_WIDTH = 8.2  # of a plate across the column
HALF_PLATE_GAP = 1.48  # between two plates above each other


@dataclass(frozen=True)
class Piece:
    """A strip of the column.

    n, p: its transistors from the west.
    west, east: nets that leave it below the adjacent plates.
    fixed: row of each net that leaves it at a fixed height.
    shields: quiet nets whose tracks are as long as the strip.
    over: nets whose tracks span another net's, as a shield.
    """

    n: tuple[str, ...]
    p: tuple[str, ...]
    west: tuple[str, ...] = ()
    east: tuple[str, ...] = ()
    fixed: Mapping[str, int] = field(default_factory=dict)
    shields: tuple[str, ...] = ()
    over: Mapping[str, str] = field(default_factory=dict)


class Cap(NamedTuple):
    """A capacitor next to a strip.

    lower, upper: nets of the plates.
    from_east: the strip of its lines is in the east.
    between_lines: F between the lines of both nets, as extracted.
    low, high: y of the upper plate.
    above: it is over the preceding capacitor, not east of it.
    """

    name: str
    lower: str
    upper: str
    from_east: bool = False
    between_lines: float = 0.0
    low: float = (HEIGHT - PLATE_WIDTH) / 2
    high: float = (HEIGHT + PLATE_WIDTH) / 2
    above: bool = False


def _hold(d: str, t: int, from_east: bool = False) -> Cap:
    tap = f"back_{d}.tap{t}."
    return Cap(f"{tap}hold", f"{tap}outer", f"{tap}inner", from_east, 4e-15 if t else 6e-15)


def _kick(d: str, from_east: bool = False) -> Cap:
    return Cap(f"back_{d}.kick", f"back_{d}.kick", f"back_{d}.x", from_east)


def _tap_piece(t: int) -> Piece:
    """Return the strip of a tap of the first diode, with its part of the decoder."""
    tap, on = f"back_a.tap{t}.", f"on{t}."
    through = "back_a.x", "back_a.f", "seln", "start_a"
    nets = f"{tap}inner", f"{tap}outer"
    rows = {"back_a.x": 5, "start_a": 6, nets[0]: 7, "back_a.f": 8, nets[1]: 9, "seln": 2}
    return Piece(
        (f"{on}nb", f"{on}na", f"{tap}join", f"{tap}write", f"{tap}far_n"),
        (f"{on}pb", f"{on}pa", "", f"{tap}far_p", f"{tap}rest"),
        through,
        (*(through if t < TAPS - 1 else ()), *nets),
        rows,
    )


PIECES = (
    Piece(
        (
            "front_a.clear",
            "front_a.in",
            "front_a.cascode",
            "front_b.clear",
            "front_b.in",
            "front_b.cascode",
            "half_rest",
            "half_a_n",
            "quarter_a_n",
            "quarter_b_n",
        ),
        (
            "",
            "front_a.top",
            "front_a.cascode_p",
            "",
            "front_b.top",
            "front_b.cascode_p",
            "",
            "half_a_p",
            "quarter_a_p",
            "quarter_b_p",
        ),
        ("out_a", "out_b"),
        ("out_a", "out_b", "quarter", "half", "cn", "vbp", "vcp"),
        # An output that comes near the other diode's line would be its light in it: out_a passes the second diode's
        # transistors below all that its line has, its line passes those of the first above all that out_a has
        {
            "out_a": 0,
            "clear": 1,
            "cn": 2,
            "column_a": 3,
            "quarter": 4,
            "vbp": 5,
            "edgen": 6,
            "half": 7,
            "vcp": 9,
            "out_b": 10,
            "edge": 11,
            "column_b": 12,
        },
        ("cn", "edge", "edgen", "vcp", "vbp"),
        {"edgen": "column_a", "vbp": "column_a", "clear": "column_b"},
    ),
    Piece(
        (
            "back_b.enter",
            "back_b.cascode",
            "back_b.reset",
            "back_b.tap0.write",
            "back_b.tap0.far_n",
            "back_b.tie",
            "back_b.in",
            "back_b.low",
            "back_b.tap0.join",
            "on0.na",
            "back_b.own_n",
            "back_b.drive",
            "select_n.nb",
            "select_n.na",
            "on0.nb",
            "go_b",
            "back_b.onto_n",
            "stop_b",
            "back_a.enter",
            "go_a",
            "back_a.in",
            "stop_a",
            "back_a.drive",
            "back_a.tap0.join",
            "back_a.cascode",
            "back_a.reset",
            "back_a.own_n",
            "back_a.tap0.write",
            "back_a.tie",
            "select.n",
            "back_a.onto_n",
            "back_a.low",
            "back_a.tap0.far_n",
        ),
        (
            "back_b.top",
            "back_b.cascode_p",
            "",
            "back_b.tap0.far_p",
            "",
            "back_b.tap0.rest",
            "back_b.high",
            "",
            "",
            "back_b.own_p",
            "",
            "select_n.pb",
            "",
            "",
            "select_n.pa",
            "",
            "back_b.onto_p",
            "",
            "on0.pb",
            "on0.pa",
            "",
            "",
            "select.p",
            "back_a.top",
            "",
            "back_a.cascode_p",
            "back_a.own_p",
            "",
            "",
            "back_a.onto_p",
            "back_a.tap0.far_p",
            "back_a.high",
            "back_a.tap0.rest",
        ),
        ("back_b.tap0.inner", "back_b.tap0.outer", "back_b.x", "back_b.kick", "cn", "vbp", "vcp"),
        ("back_a.x", "back_a.f", "seln", "start_a", "back_a.tap0.inner", "back_a.tap0.outer", "back_a.kick"),
        # Between x and what its sample is not to depend on: kick, start_a. Next to cin_a: no node of the other diode's
        {
            "cn": 2,
            "vbp": 5,
            "vcp": 9,
            "seln": 2,
            "cin_a": 0,
            "reads": 1,
            "cin_b": 4,
            "back_b.x": 6,
            "back_b.kick": 7,
            "back_b.tap0.inner": 8,
            "back_b.tap0.outer": 10,
            "back_b.above": 12,
            "start": 12,
            "back_b.f": 9,
            "back_b.out": 11,
            "sense_b": 11,
            "back_a.kick": 3,
            "back_a.x": 5,
            "start_a": 6,
            "back_a.tap0.inner": 7,
            "back_a.f": 8,
            "back_a.tap0.outer": 9,
        },
        over={"back_b.kick": "back_b.tap0.inner", "start_a": "back_a.x"},
    ),
    *map(_tap_piece, range(1, TAPS)),
)
# Between the strips, and at both ends of the column
CAPS = (
    (
        Cap("front_a.f", "out_a", "column_a", True, 0.6e-15, high=(HEIGHT - HALF_PLATE_GAP) / 2),
        Cap("front_b.f", "out_b", "column_b", True, 0.6e-15, low=(HEIGHT + HALF_PLATE_GAP) / 2, above=True),
    ),
    (
        Cap("in_a", "out_a", "cin_a"),
        Cap("in_quarter", "quarter", "cin_a"),
        Cap("in_half", "half", "cin_a"),
        Cap("in_b", "out_b", "cin_b"),
        _kick("b", True),
        _hold("b", 0, True)._replace(lower="back_b.tap0.inner", upper="back_b.tap0.outer"),  # cin_a passes above
    ),
    (_kick("a"), _hold("a", 0)),
    *((_hold("a", t),) for t in range(1, TAPS)),
)
