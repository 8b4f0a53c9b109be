"""The table of extreme cases of the inverse side holds, with every warning of NumPy an error."""

import warnings

import numpy as np
import pytest

from talbot.models.stability_inverse import GROUPS

CASES = {"light fields": 12, "polarization": 7, "depths": 14, "calibrations": 5}  # at least


@pytest.mark.parametrize("group", [pytest.param("light fields", marks=pytest.mark.slow), *list(CASES)[1:]])
def test_every_case_holds(group):
    with warnings.catch_warnings(), np.errstate(all="raise", under="ignore"):
        warnings.simplefilter("error")
        cases = GROUPS[group]()
    assert len(cases) >= CASES[group] and [case for case in cases if not case.ok] == []
    assert len({case.name for case in cases}) == len(cases)
    assert all([type(v) for v in vars(case).values()] == [str, str, str, bool] for case in cases)


def test_every_group_is_tried():
    assert GROUPS.keys() == CASES.keys()
