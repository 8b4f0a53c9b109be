"""Whole frames: the chip's Verilog against the golden chip, byte for byte, in every mode, at odd sizes."""

from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from talbot.imaging.frame import hardware
from talbot.imaging.frame.request import request
from talbot.imaging.simulate.build import Build
from talbot.imaging.simulate.icarus import icarus_program
from talbot.models.chip import front_end_of, golden_frame
from talbot.models.digital.stream import decode_stream
from talbot.models.parameters import MODES, ConverterParameters, SensorParameters, Window, circuit_converter

SIZES = {"odd": (13, 50, 4), "row": (1, 37, 8), "tile": (4, 6, 1)}  # rows, cols, lanes
TAPS = 4


def exposure(sensor, seed, span=20.0):
    """Random diode pairs (4, rows, cols, 2) whose differences reach past the converter's range now and then."""
    rng = np.random.default_rng(seed)
    common = rng.uniform(0, 128, (TAPS, sensor.array.rows, sensor.array.cols, 1))
    return common + rng.normal(0, span, (*common.shape[:3], 2)) * (rng.random(common.shape) < 0.3)


def check(program, asked, front_end, samples, stall=0):
    """Run one frame; stream, decoded samples and the chip's own counters must be the golden model's."""
    golden = golden_frame(samples, asked.sensor, asked.frame, front_end)
    chip = hardware.simulate(program, asked.sensor, asked.frame, samples, front_end, stall=stall)
    assert chip.stream == golden.stream
    assert chip.status["conversions_made"] == golden.made
    assert chip.status["conversions_left_out"] == golden.left_out
    assert not chip.status["cfg_err"] and not chip.status["refused"]
    (frame,) = decode_stream(chip.stream, asked.sensor.tile)
    assert frame.complete and (frame.samples == golden.sent).all() and (frame.read == golden.read).all()
    return chip


def asked_of(size, **options):
    rows, cols, lanes = SIZES[size]
    return request(rows=rows, cols=cols, lanes=lanes, **options)


MODE_CASES = [*((mode, False) for mode in MODES), ("tof", True)]


@cache
def program_of(size):
    """The compiled bench of a size, when a test wants it: workers that share the tests compile at the same time."""
    return hardware.program(asked_of(size).sensor)


@pytest.mark.parametrize("mode, phase", MODE_CASES)
@pytest.mark.parametrize("size", ["odd", *(pytest.param(name, marks=pytest.mark.slow) for name in ("row", "tile"))])
def test_every_mode_at_odd_sizes(size, mode, phase):
    asked = asked_of(size, mode=mode, phase=phase)
    check(program_of(size), asked, front_end_of(asked.sensor, [7] * 24), exposure(asked.sensor, 1))


@settings(max_examples=30, deadline=None)
@given(
    data=st.data(),
    mode=st.sampled_from(MODE_CASES),
    threshold=st.integers(0, 127),
    decimation=st.integers(0, 3),
    types=st.sets(st.integers(0, 23), min_size=1),
    overlap=st.booleans(),
    lead=st.integers(0, 40),
    stall=st.integers(0, 240),
    seed=st.integers(0, 99),
)
def test_windows_masks_and_back_pressure(data, mode, threshold, decimation, types, overlap, lead, stall, seed):
    row0, row1 = sorted(data.draw(st.tuples(st.integers(0, 2), st.integers(0, 2))))
    col0, col1 = sorted(data.draw(st.tuples(st.integers(0, 7), st.integers(0, 7))))
    asked = asked_of(
        "odd",
        window=lambda full: Window(row0, row1, col0, col1),
        mode=mode[0],
        phase=mode[1],
        mask=sum(1 << t for t in types),
        threshold=threshold,
        decimation=decimation,
        overlap=overlap,
        exposure=lead,
    )
    front_end = front_end_of(asked.sensor, np.random.default_rng(seed).integers(-512, 512, 24))
    check(program_of("odd"), asked, front_end, exposure(asked.sensor, seed), stall)


ROUGH = ConverterParameters(inl=2, dnl=0.5, offset=3, noise=1.5, ktc=1, unit_mismatch=0.05, seed=5)


@pytest.mark.parametrize("converter", [ROUGH, circuit_converter()], ids=["rough", "circuit"])
@pytest.mark.parametrize("mode", MODES)
def test_imperfect_converters(mode, converter):
    asked = asked_of("odd", mode=mode, threshold=9)
    sensor = SensorParameters(array=asked.sensor.array, chip=asked.sensor.chip, converter=converter)
    front_end = front_end_of(sensor, [0] * 24)
    assert front_end.converter is not None
    samples = exposure(sensor, 3)
    golden = golden_frame(samples, sensor, asked.frame, front_end)
    assert hardware.simulate(program_of("odd"), sensor, asked.frame, samples, front_end).stream == golden.stream


@pytest.mark.needs("iverilog")
def test_icarus_sends_the_same_bytes(tmp_path):
    asked = asked_of("odd", threshold=9, exposure=5)
    front_end, samples = front_end_of(asked.sensor, [7] * 24), exposure(asked.sensor, 2)
    program = icarus_program(Build.of(asked.sensor), tmp_path)
    chip = check(program, asked, front_end, samples)
    assert chip.status["cycles"] == check(program_of("odd"), asked, front_end, samples).status["cycles"]
