"""Waves of some rows, in every format that this machine can compile."""

import math
import re
import struct

import pytest

from talbot.base.verilator import has_headers
from talbot.flow.frame import job
from talbot.flow.frame.hardware import program
from talbot.flow.frame.request import request
from talbot.flow.simulate.frame import Waves
from talbot.flow.simulate.verilator import PACKED
from talbot.models.parameters import ParameterError

ROWS = 1, 2
FST = pytest.mark.skipif(not has_headers(PACKED), reason=f"no {' and '.join(PACKED)}")


@pytest.mark.parametrize("kind", ["vcd", pytest.param("fst", marks=FST)])
def test_waves(kind, tmp_path):
    asked = request(scene="coins", rows=8, cols=12, waves=ROWS, waves_format=kind)
    exposed = job.expose(asked, *job.see(asked))
    built = program(asked.sensor, kind)
    result = job.read_out(asked, exposed, built, waves=Waves(tmp_path / "waves", *ROWS))
    assert result.stream == result.golden.stream
    data = (tmp_path / "waves").read_bytes()
    if kind == "fst":
        _, _, first, last, mark = struct.unpack(">BQQQ8s", data[:33])  # the header's block
        assert struct.unpack("<d", mark)[0] == pytest.approx(math.e) and 0 < first < last
        return
    text = data.decode()
    name = re.search(r"\$var wire +10 (\S+) row ", text)
    assert name
    rows = {int(value, 2) for value in re.findall(rf"^b([01]+) {re.escape(name[1])}$", text, re.MULTILINE)}
    assert rows == {1, 2, 3}  # the clock edge that ends the last row is there


def test_headers_that_are_missing():
    assert has_headers(["cstdio"]) and not has_headers(["no_such_header.h"])


@pytest.mark.parametrize("given", [{"waves_format": "fst"}, {"waves_format": "gtkw", "waves": ROWS}])
def test_a_format_of_no_waves(given):
    with pytest.raises(ParameterError, match="waves_format = "):
        request(rows=8, cols=12, **given)
