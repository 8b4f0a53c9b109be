"""The wrappers from their pins against the golden models: as Verilog, or as the netlists of --netlist."""

from dataclasses import replace

import numpy as np
import pytest

from talbot.models.chip import golden_frame
from talbot.models.digital.amp_ctrl import waveform
from talbot.models.digital.divider import quad_divide
from talbot.models.digital.pattern import PatternEnd
from talbot.models.parameters import AmpTiming, SensorParameters, Window
from talbot.rtl.export import translate
from talbot.rtl.tinytapeout.golden import EXAMPLES, PATTERN_FRAME, transfers
from talbot.rtl.tinytapeout.host import ADDRESS, SHOW, WAIT, divisions, frame, row, simulate

DIVIDER, AMP_CTRL, CHIP = EXAMPLES
TRIMS = [3, -2, 511, -512] * 6
PINS = ("pixel_reset", "shutter", "ref_ctl", "integrate", "cm_reset", "read", "sample", "busy")


@pytest.fixture
def host(given_verilog, tmp_path):
    """host(top, words): what the host shows, lines of '<uio_out> <uo_out>'."""

    def call(top, words):
        files = given_verilog(top)
        if not files:
            files = [tmp_path / f"{top}.v"]
            files[0].write_text(translate(top, SensorParameters()))
        return simulate(top, words, files, tmp_path)

    return call


class TestDividerIcarus:
    verilog = "icarus"

    def test_it_gives_what_the_golden_model_gives(self, host):
        rng = np.random.default_rng(5)
        pairs = [(0, 0), (-256, 255), (255, 255), (0, -256), (100, 100), *rng.integers(-256, 256, (25, 2)).tolist()]
        requests = [
            (x, y, floor) for (x, y), floor in zip(pairs, rng.integers(0, 64, len(pairs)).tolist(), strict=True)
        ]
        expected = []
        for x, y, floor in requests:
            r = quad_divide(x, y, noise_floor=floor)
            flags = int(r.octant) << 5 | int(r.zero) << 4 | int(r.amp_valid) << 3
            expected += [f"10000000 {int(value):08b}" for value in (r.phase, r.ratio, r.amp, flags)]
        *said, enabled = host(DIVIDER, divisions(requests))
        assert said == expected and enabled == "enabled 11000000"

    def test_a_start_during_a_division_drops_it(self, host):
        words = [ADDRESS, 7, 3, 0, 0, ADDRESS | 3, 0, ADDRESS, 200, 100, 0, 0, WAIT, ADDRESS, SHOW]
        assert host(DIVIDER, words)[0] == f"10000000 {int(quad_divide(200, 100).phase):08b}"


class TestAmpCtrlIcarus:
    verilog = "icarus"

    @pytest.mark.parametrize("four_tap, n_cm", [(False, 0), (True, 3)])
    def test_the_row_is_the_golden_waveform(self, host, four_tap, n_cm):
        timing = AmpTiming(5, 300, 4, 3, 6, 2, n_cm)
        expected = waveform(timing, four_tap, np.ones(20000, bool))
        cycles = len(expected["busy"])
        rows = [line for line in host(AMP_CTRL, row(timing, four_tap, cycles)) if " " in line and line[0] in "01x"]
        first = next(k for k, line in enumerate(rows) if line.split()[1][0] == "1")  # busy
        for k in range(cycles):
            uio, uo = rows[first + k].split()
            pins = {name: int(uo[7 - bit]) for bit, name in enumerate(PINS)} | {
                "done": int(uio[0]),
                "cfg_err": int(uio[1]),
                "tap": int(uio[2:4], 2),
            }
            assert pins == {name: int(expected[name][k]) if name in expected else 0 for name in pins}, k


class TestChipIcarus:
    verilog = "icarus"

    @pytest.mark.parametrize(
        "asked",
        [PATTERN_FRAME, replace(PATTERN_FRAME, mode="edge", phase=False, threshold=3, window=Window(0, 1, 2, 3))],
        ids=["tof", "edge"],
    )
    def test_the_frame_is_the_golden_chip_s(self, host, asked):
        sensor = SensorParameters()
        samples = np.zeros((4, *sensor.shape, 2))
        expected = golden_frame(samples, sensor, asked, PatternEnd(*sensor.shape, sensor.tile)).stream
        said = [line.split() for line in host(CHIP, frame(transfers(asked, TRIMS))) if " " in line and line[0] in "01x"]
        sent = bytes(int(data, 2) for flags, data in said if flags[1] == "1")  # link_val
        assert sent == expected
        busy = [flags[0] for flags, _ in said]
        assert busy[-1] == "0" and "1" in busy and not any("x" in flags for flags, _ in said)


@pytest.mark.needs("iverilog")
def test_the_examples_run(host, tmp_path):
    for top, words in EXAMPLES.items():
        said = host(top, words)
        assert len(set(said)) > 8 and "timeout" not in said
