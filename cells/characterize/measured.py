"""The types of what is measured of a cell: plain data that JSON holds, in SI units."""

from collections.abc import Sequence
from typing import Any, NotRequired, TypedDict

from talbot.cells.netlist.function import Arc
from talbot.cells.netlist.states import Output, State

Rows = list[list[float]]


class Failure(TypedDict):
    """A measurement that failed: ``deck`` is a netlist that reproduces it."""

    what: str
    why: str
    deck: str


class ArcTables(TypedDict):
    """The tables of a `cells.netlist.function.Arc`, (slews, loads) each; state: levels of the inputs before it.

    An arc that lets an output go has no energy.
    """

    pin: str
    pin_edge: str
    output: str
    edge: str
    type: str
    sense: str
    slews: Sequence[float]
    loads: Sequence[float]
    state: list[int]
    delay: Rows
    slew: Rows
    energy: NotRequired[Rows]


class Constraint(TypedDict):
    """A constraint of ``pin`` by its edge: (slews of ``related``, slews of ``pin``), or one value a slew of a pulse."""

    pin: str
    related: str
    type: str
    slews: Sequence[float]
    rise: NotRequired[Rows | list[float] | None]
    fall: NotRequired[Rows | list[float] | None]


class Measured(TypedDict):
    """All measurements of a cell at a corner.

    longest_slew: s, limit of an output's slew.
    largest_load: F at which an output has that slew.
    interpolation_error: relative, of every output.
    capacitance: (rise, fall) in F of every input and of outputs that float.
    quiet_energy: of every input, by edge and slew.
    leakage: (levels of the inputs, of the outputs, W) of every state.
    simulations, repeated: number of transients, and of those that needed a retry.
    wall_s: elapsed time.
    cpu_s: CPU time of this process and of ngspice.
    """

    name: str
    failed: list[Failure]
    slews: Sequence[float]
    longest_slew: float
    largest_load: dict[str, float]
    interpolation_error: dict[str, float]
    arcs: list[ArcTables]
    capacitance: dict[str, tuple[float, float] | None]
    quiet_energy: dict[str, dict[str, list[float]] | None]
    constraints: list[Constraint]
    leakage: list[tuple[list[int], list[Output], float]]
    simulations: int
    repeated: int
    wall_s: float
    cpu_s: float


def arc_tables(
    arc: Arc, slews: Sequence[float], loads: Sequence[float], state: State, delay: Rows, slew: Rows
) -> ArcTables:
    """Name the tables of ``arc``, measured in ``state``."""
    fields = ("pin", "pin_edge", "output", "edge", "type", "sense")
    names: dict[str, Any] = {name: getattr(arc, name) for name in fields}
    return ArcTables(**names, slews=slews, loads=loads, state=list(state.inputs), delay=delay, slew=slew)
