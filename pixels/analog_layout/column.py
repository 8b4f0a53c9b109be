"""A column on the pixels' pitch, lying: the array in the west, the converters in the east; n transistors at y = 0.

    column_a ---- Cf Cf | front strip |  Cin  Cin  Cin  | back strip | Chold Chold Chold Chold Chold
    column_b ----       |             |                 |            |

    rail vdd   ================
               p  transistors of both charge amplifiers; of the second stages, the taps, the decoder
    rail vss   ================

Capacitors are metal-insulator-metal, their lower plates at what is driven. Under them run the lines of the second metal,
each at its track's height in the strip that it comes from. What crosses all columns is on the fourth metal over the
strips: a column has a via at its own of the lanes' lines, of the groups' and of the places'.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import sqrt

from talbot.models.parameters import ParameterError
from talbot.pixels.circuits.column import BIASES, CONTROLS, OF_TAPS, PINS, SUPPLIES, column
from talbot.pixels.circuits.column_block import GROUPS, PLACES
from talbot.pixels.circuits.column_sizes import FINGER, ColumnSizes
from talbot.pixels.layout.canvas import Canvas
from talbot.platforms.analog import AnalogMasks

from . import flat
from .array import AROUND, TAB, VIA_IN
from .cells import Cell, new_canvas
from .device import GRID, Device, Strap, snap
from .flat import Plate, Tap
from .strip import (
    FOURTH,
    RAIL_AT,
    RAIL_ENDS,
    RAIL_TRUNK,
    SECOND,
    THIRD,
    Placed,
    Plan,
    Strip,
    draw_rails,
    draw_rows,
    in_columns,
    join_rails,
)

# um
PITCH, BETWEEN = 10.0, 1.2  # of the columns; of the rails' middles of two columns
WIDE = 8.2  # of a plate across the column
LINE, LINE_PITCH = 0.4, 0.8  # of what crosses all columns
LANE, LANE_PITCH = 0.6, 1.0  # of the lanes' lines
ROOM = 0.6  # beside each pair of devices, for its drops
PAD_AT, PLATE_AT = 0.85, 1.8  # of an upper plate's vias from the one before it, and of the plate itself
UNDER = 0.28  # width of the lines under the plates
EXIT = 3.2  # from a strip's end to the plates beside it
PIN_AT = {"column_a": 2.5, "column_b": 7.5}
LANES = 8

# Pairs (n, p) of the strips from the west
FRONT = (
    ("front_a.clear", None),
    ("front_a.in", "front_a.top"),
    ("front_a.cascode", "front_a.cascode_p"),
    ("quarter_a_n", "quarter_a_p"),
    ("half_a_n", "half_a_p"),
    ("half_rest", None),
    ("quarter_b_n", "quarter_b_p"),
    ("front_b.cascode", "front_b.cascode_p"),
    ("front_b.in", "front_b.top"),
    ("front_b.clear", None),
)
DECODER = (
    ("select_n.na", "select_n.pa"),
    ("select_n.nb", "select_n.pb"),
    ("select.n", "select.p"),
    *((f"on{t}.n{leg}", f"on{t}.p{leg}") for t in range(4) for leg in "ab"),
)


def _back(d: str) -> tuple[tuple[str | None, str | None], ...]:
    """Pairs of a diode's second stage."""
    back = f"back_{d}."
    return (
        (f"{back}enter", None),
        (f"{back}tie", None),
        (f"{back}reset", f"{back}top"),
        (f"{back}cascode", f"{back}cascode_p"),
        (f"{back}in", f"{back}own_p"),
        (f"{back}drive", f"{back}onto_p"),
        (f"go_{d}", None),
        (f"stop_{d}", None),
        (f"{back}onto_n", None),
        (f"{back}own_n", None),
    )


def _tap(d: str, t: int) -> tuple[tuple[str | None, str | None], ...]:
    """Pairs of a tap."""
    own = f"back_{d}.tap{t}."
    return (f"{own}write", f"{own}rest"), (f"{own}join", None), (f"{own}far_n", f"{own}far_p")


BACK = (*_back("b"), *_tap("b", 0), *DECODER, *_back("a"), *(pair for t in range(4) for pair in _tap("a", t)))
ACROSS = tuple(name for name in (*CONTROLS, *OF_TAPS, "vbp", "vcp", "level", "start"))


@dataclass(frozen=True)
class ColumnPlan:
    """Where everything of a column is, um.

    front, back: the strips. lines: x of what crosses all columns, of both strips. joints: of the supplies that do.
    plates: (capacitor, lower net, upper net, x, um along the column). right: its east end.
    """

    front: Plan
    back: Plan
    lines: Mapping[str, float]
    joints: Mapping[str, tuple[float, ...]]
    plates: Sequence[tuple[str, str, str, float, float]]
    right: float


def length_um(farad: float, masks: AnalogMasks) -> float:
    """Of a plate WIDE um across. Raises ParameterError where it would be under 1 um."""
    area, edge = masks.mim_area, masks.mim_edge
    found = snap((farad * 1e15 - 2 * edge * WIDE) / (area * WIDE + 2 * edge))
    if found < 1:
        raise ParameterError(f"capacitor = {farad:g} F: must be 1 um long at the least, {WIDE:g} um wide")
    return found


def devices(circuit_of: ColumnSizes) -> dict[str, Device]:
    """All transistors of a column, in fingers that fit its pitch."""
    return {t.name: Device.of(t, FINGER) for t in flat.transistors(column(circuit_of))}
