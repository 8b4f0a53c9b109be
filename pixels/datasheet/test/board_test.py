"""A group of lanes takes the current of each; parts out of range are named."""

import pytest

from talbot.cells.corner import Corner
from talbot.models.parameters import ParameterError
from talbot.pixels.circuits.board import REFERENCES, RISER, SQUARE, STRAP, Board
from talbot.pixels.datasheet.deck import simulator


@pytest.mark.parametrize("changes", [{"source": 0.0}, {"farad": 1.0}, {"bond_henry": float("nan")}, {"chip": -1e-12}])
def test_a_part_out_of_range_is_refused_by_name(changes):
    with pytest.raises(ParameterError, match=f"{next(iter(changes))} = "):
        Board(**changes)


@pytest.mark.needs("ngspice")
def test_one_lane_stands_for_its_group():
    """At rest: drops by 1 mA of the far lane and 3 mA of the near group along source, bond, riser and strap."""
    board = Board()
    lines = [*board.lines((1, 3)), *(f"I{name}{k} {name}{k} 0 1m" for name in REFERENCES for k in (0, 1))]
    rails = {f"{name}_ext": 1.0 for name in REFERENCES}
    with simulator(lines, ("in",), ("refp0", "refp1"), Corner("tt", 27.0, 1.8), rails) as spice:
        wave = spice.transient({"in": [(0.0, 0.0)]}, {}, 1e-6, 1e-8)
    near = 1.0 - 4e-3 * (board.source + board.bond_ohm + 1e-3 + RISER * SQUARE)
    assert wave.at("refp1", 1e-6) == pytest.approx(near, abs=1e-4)
    assert wave.at("refp0", 1e-6) == pytest.approx(near - 1e-3 * 3 * STRAP * SQUARE, abs=1e-4)
