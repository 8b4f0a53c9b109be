"""Waves of some rows as FST, and formats that are refused; as VCD: talbot/test/sim_test.py."""

import math
import struct

import pytest

from talbot.base.verilator import has_headers
from talbot.imaging.frame import job
from talbot.imaging.frame.hardware import program
from talbot.imaging.frame.request import request
from talbot.imaging.simulate.frame import Waves
from talbot.models.parameters import ParameterError

ROWS = 1, 2


@pytest.mark.slow
@pytest.mark.needs("fst")
def test_waves(tmp_path):
    asked = request(scene="coins", rows=8, cols=12, waves=ROWS, waves_format="fst")
    exposed = job.expose(asked, *job.see(asked))
    built = program(asked.sensor, "fst")
    result = job.read_out(asked, exposed, built, waves=Waves(tmp_path / "waves", *ROWS))
    assert result.stream == result.golden.stream
    header = (tmp_path / "waves").read_bytes()[:33]
    _, _, first, last, mark = struct.unpack(">BQQQ8s", header)
    assert struct.unpack("<d", mark)[0] == pytest.approx(math.e) and 0 < first < last


def test_headers_that_are_missing():
    assert has_headers(["cstdio"]) and not has_headers(["no_such_header.h"])


@pytest.mark.parametrize("given", [{"waves_format": "fst"}, {"waves_format": "gtkw", "waves": ROWS}])
def test_a_format_of_no_waves(given):
    with pytest.raises(ParameterError, match="waves_format = "):
        request(rows=8, cols=12, **given)
