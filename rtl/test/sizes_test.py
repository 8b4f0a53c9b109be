"""Every block refuses what rtl.sizes does not list; phase paths of every width differ in their divider alone."""

import re

import pytest

from talbot.models.parameters import DIVIDERS, ChipParameters, ParameterError, SensorParameters
from talbot.rtl.adc_bank import AdcBank
from talbot.rtl.asp_chip.balance_rtl import Balance
from talbot.rtl.asp_chip.pattern_rtl import Pattern
from talbot.rtl.export import translate
from talbot.rtl.phase_path import PhasePath
from talbot.rtl.quad_divider import quad_divider
from talbot.rtl.readout_seq import ReadoutSeq
from talbot.rtl.reg_file import RegFile
from talbot.rtl.run_length import RunLength
from talbot.rtl.sizes import BUILD


@pytest.mark.parametrize(
    "build, message",
    [
        (lambda: AdcBank(3), "lanes = 3: must be one of 1, 2, 4, 8, 16, 32"),
        (lambda: Pattern(64), "lanes = 64: must be one of 1, 2, 4, 8, 16, 32"),
        (lambda: PhasePath(0), "lanes = 0: must be one of 1, 2, 4, 8, 16, 32"),
        (lambda: PhasePath(8, "radix8"), "divider = 'radix8': must be one of radix2, radix4, pipelined, cordic"),
        (lambda: PhasePath(8, "none"), "divider = 'none': must be one of radix2, radix4, pipelined, cordic"),
        (lambda: PhasePath(8, "radix2", 17), "n_frac = 17: must be an integer in 4..16"),
        (lambda: PhasePath(8, "cordic", 8, 3), "iterations = 3: must be an integer in 4..16"),
        (lambda: quad_divider("radix4", 3), "n_frac = 3: must be an integer in 4..16"),
        (lambda: Balance((0,), 5, 1, 10, 16), "tile_rows = 5: must be an integer in 1..4"),
        (lambda: Balance((0, 0), 1, 2, 10, 16), "order = (0, 0): must be a permutation of 0..1"),
        (lambda: ReadoutSeq(1025, 6, 1, (0,), 1, 1), "rows = 1025: must be an integer in 1..1024"),
        (lambda: ReadoutSeq(300, 1, 1, (0,), 1, 1), "array = 300 x 1: must be at most 256 x 256 tiles of 1 x 1"),
        (lambda: RunLength(8, 0, 2, 4, 6), "cols = 0: must be an integer in 1..1536"),
        (lambda: RunLength(8, 13, 2, 4, 7), "tile_cols = 7: must be an integer in 1..6"),
        (
            lambda: RegFile(8, 13, 2, divider="radix3"),
            "divider = 'radix3': must be one of radix2, radix4, pipelined, cordic, none",
        ),
    ],
)
def test_a_size_that_no_proof_has_is_refused(build, message):
    with pytest.raises(ParameterError) as error:
        build().elaborate()
    assert str(error.value) == message


def around(divider, n_frac=8, iterations=10):
    """The modules of PhasePath without its divider, the type of whose response is not looked into."""
    text = translate("PhasePath", SensorParameters(chip=ChipParameters(2, divider, n_frac, iterations)))
    modules = re.findall(r"(?s)^module ((?:PhasePath|Tap)\w*)(.*?)^endmodule", text, re.MULTILINE)
    return {name: re.sub(r"DivResp_\d+|//.*", "", body) for name, body in modules}


@pytest.mark.parametrize("step", [12, pytest.param(1, marks=pytest.mark.slow)])
@pytest.mark.parametrize("divider", DIVIDERS)
def test_only_the_divider_of_a_phase_path_depends_on_its_width(divider, step):
    """It is tested for all of its inputs at each width (rtl/quad_divider/test/gates_test.py)."""
    proven = around(divider)
    assert len(proven) == 3 and "divider__send__msg.amp_valid" in proven["PhasePath"]
    for name in ("n_frac", "iterations"):
        for value in BUILD[name][::step]:
            assert around(divider, **{name: value}) == proven, value
