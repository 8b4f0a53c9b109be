"""Row driver, line, switch drivers and bias as data: values, and what is broken is named."""

from dataclasses import replace

import pytest

from talbot.models.parameters import ParameterError
from talbot.pixels.circuits.support import SECTIONS, SupportSpec, bias, non_overlap, row_driver, row_line
from talbot.platforms.sky130 import analog as process

SPEC = SupportSpec.of()


def test_specification_is_the_sensors():
    assert SPEC.cols == 384 and SPEC.settle == 100e-9


@pytest.mark.parametrize("changes", [{"cols": 0}, {"ohm": float("nan")}, {"gap": 0.0}, {"bias": 2}, {"switches": -1}])
def test_a_value_out_of_range_is_refused_by_name(changes):
    with pytest.raises(ParameterError, match=f"{next(iter(changes))} = "):
        replace(SPEC, **changes)


def test_all_are_whole():
    for one in (row_driver(), row_line(SPEC), non_overlap(), bias()):
        one.check(process)


def test_a_line_has_the_resistance_and_capacitance_of_its_columns():
    line = row_line(SPEC)
    assert sum(r.value for r in line.resistors) == pytest.approx(384 * SPEC.ohm)
    assert sum(c.value for c in line.capacitors) == pytest.approx(384 * SPEC.farad)
    assert len(line.capacitors) == SECTIONS


def test_what_is_broken_is_named():
    with pytest.raises(ParameterError, match="circuit row_line: net n8 at device a8: must have two ends"):
        row_line(SPEC).without("b7").check(process)
    with pytest.raises(ParameterError, match="circuit bias: net source at device four_0: must have two ends"):
        bias().without("r").check(process)
