"""A call in a process of its own ends when its work is done."""

import pytest

from talbot.base.jobs import Job, run
from talbot.base.steps.alone import alone


def wide(folder):
    return sum(run([Job(f"n{n}", int, (n,)) for n in range(3)], folder, "numbers", workers=2))


@pytest.mark.timeout(200)  # joblib's workers stay for 300 s
def test_what_went_wide_does_not_wait_for_idle_workers(tmp_path):
    assert alone(wide, tmp_path / "store")[0] == 3
