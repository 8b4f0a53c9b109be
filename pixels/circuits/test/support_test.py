"""Switch drivers and bias as data: values, and what is broken is named."""

from dataclasses import replace

import pytest

from talbot.models.parameters import ParameterError
from talbot.pixels.circuits.support import SupportSpec, bias, non_overlap
from talbot.platforms.sky130 import analog as process

SPEC = SupportSpec()


@pytest.mark.parametrize("changes", [{"lost": float("nan")}, {"gap": 0.0}, {"bias": 2}, {"switches": -1}])
def test_a_value_out_of_range_is_refused_by_name(changes):
    with pytest.raises(ParameterError, match=f"{next(iter(changes))} = "):
        replace(SPEC, **changes)


def test_all_are_whole():
    for one in (non_overlap(), bias()):
        one.check(process)


def test_what_is_broken_is_named():
    with pytest.raises(ParameterError, match="circuit bias: net source at device four_0: must have two ends"):
        bias().without("r0").check(process)
