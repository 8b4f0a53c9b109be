import numpy as np
import pytest

from talbot.base.tools import ToolError
from talbot.imaging.simulate.divider.exhaustive import Divider, compare, errors, every_input, measure, pack, unpack
from talbot.imaging.simulate.divider.simulator import program, simulate
from talbot.models.digital.divider import QuadResult, quad_divide
from talbot.models.parameters import DIVIDERS
from talbot.rtl.messages import DivReq, div_resp
from talbot.rtl.quad_divider import timing

X, Y = every_input()


@pytest.fixture(scope="module")
def radix4():
    return Divider("radix4").verilog()


@pytest.mark.slow  # rtl/quad_divider/test/gates_test.py has every request
def test_every_input_through_the_verilog(radix4):
    found = measure(Divider("radix4"))
    assert found.mismatches == 0
    assert (found.latency, found.interval) == timing("radix4", 8)
    assert found.worst < 0.75 and found.cycles == X.size * found.interval


@pytest.mark.slow
def test_finds_one_wrong_threshold(radix4):
    """A table entry that is one too high gives wrong phases for one ratio, and no other mismatch."""
    text, top = radix4
    assert text.count("8'd226;") == 1
    bench = program(text.replace("8'd226;", "8'd227;"), top)
    mismatches, _, _ = compare(bench, X, Y, Divider("radix4"))
    assert mismatches == (quad_divide(X, Y, 8).ratio == 226).sum() > 0


@pytest.mark.slow
def test_waiting_lengthens_and_changes_nothing(radix4):
    requests = pack(X[::4099], Y[::4099])
    bench = program(*radix4)
    straight, waiting = simulate(bench, requests), simulate(bench, requests, seed=3)
    assert (straight.responses == waiting.responses).all() and waiting.cycles > straight.cycles


def test_pack_and_unpack_are_the_messages():
    for x, y in [(0, 0), (-256, 255), (17, -1)]:
        assert pack(np.array(x), np.array(y)) == int(DivReq(x, y).to_bits())
    for bits, values in [(4, (7, 15, 1, 255, 1, 0)), (16, (3, 40000, 0, 129, 0, 255))]:
        message = div_resp(bits)(*values)
        result = unpack(np.array([int(message.to_bits())], np.uint64), bits)
        assert [int(getattr(result, f)[0]) for f in QuadResult.__dataclass_fields__] == list(values)


def test_the_golden_phase_is_within_half_an_lsb():
    for variant in DIVIDERS:
        worst, rms = errors(Divider(variant, 12, 12).golden(X, Y).phase, X, Y)
        assert 0.5 < worst < 0.52 and 0.28 < rms < 0.29


def test_names_what_failed():
    with pytest.raises(ToolError, match="verilator_bin failed"):
        program("module Bad (output logic y); assign y = nothing; endmodule", "Bad")
