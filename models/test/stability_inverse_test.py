"""The table of extreme cases of the inverse side holds, with every warning of NumPy an error."""

import warnings

import numpy as np

from talbot.models.stability_inverse import inverse_cases


def test_every_case_holds():
    with warnings.catch_warnings(), np.errstate(all="raise", under="ignore"):
        warnings.simplefilter("error")
        cases = inverse_cases()
    assert len(cases) > 25 and [case for case in cases if not case.ok] == []
    assert len({case.name for case in cases}) == len(cases)
    assert all([type(v) for v in vars(case).values()] == [str, str, str, bool] for case in cases)
