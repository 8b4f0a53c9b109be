"""The table of extreme optical cases holds, with every warning of NumPy an error."""

import warnings

import numpy as np
import pytest

from talbot.models.stability import optical_cases


@pytest.fixture(scope="module")
def cases():
    with warnings.catch_warnings(), np.errstate(all="raise", under="ignore"):
        warnings.simplefilter("error")
        return optical_cases()


def test_every_case_holds(cases):
    assert len(cases) > 50 and [c for c in cases if not c.ok] == []


def test_names_differ(cases):
    assert len({c.name for c in cases}) == len(cases)


def test_a_case_is_plain_text_and_a_verdict(cases):
    for case in cases:
        assert [type(v) for v in (case.name, case.bound, case.measured, case.ok)] == [str, str, str, bool], case
