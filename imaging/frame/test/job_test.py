"""The main job's parts that run at the same time."""

import time

import pytest

from talbot.base.tools import finish
from talbot.imaging.frame import hardware, job
from talbot.imaging.frame.request import request
from talbot.models.parameters import ParameterError


def test_a_scene_that_cannot_be_captured_ends_the_compiler(monkeypatch):
    def refused(*arguments):
        raise ParameterError("scene = 'flat': must be another")

    monkeypatch.setattr(hardware, "program", lambda *arguments: finish(["sleep", "100"]))
    monkeypatch.setattr(job, "expose", refused)
    start = time.monotonic()
    with pytest.raises(ParameterError, match="must be another"):
        job.simulate_frame(request(4, 6, scene="flat"))
    assert time.monotonic() - start < 90
