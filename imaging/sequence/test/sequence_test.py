"""Sequences through one running simulation: every frame's bytes are the golden chip's, its state stays."""

from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

from talbot.base.tools import ToolError
from talbot.imaging.frame import hardware
from talbot.imaging.frame.job import Clock, simulate_frame
from talbot.imaging.frame.request import request
from talbot.imaging.frame.test.frame_test import MODE_CASES, asked_of, exposure
from talbot.imaging.sequence.job import results
from talbot.imaging.simulate.build import Build
from talbot.imaging.simulate.icarus import icarus_program
from talbot.imaging.simulate.running import running
from talbot.models.afe import write_converter
from talbot.models.chip import front_end_of, golden_frame
from talbot.models.digital.exposure import integration_cycles
from talbot.models.digital.stream import decode_stream
from talbot.models.parameters import ConverterParameters
from talbot.models.scene import Sampling, open_clip

SIZE = {"rows": 13, "cols": 50, "lanes": 4}


def pictures(count, contrast=1.0, seed=3):
    """A texture that moves over the array."""
    wide = np.random.default_rng(seed).random((20, 90))
    return [0.5 + contrast * (wide[:, 2 * n : 2 * n + 60] - 0.5) for n in range(count)]


def frames_of(asked, arrays):
    return [shown.result for shown in results(asked, open_clip(arrays, Sampling.of(asked.sensor)), Clock())]


def numbered(front_end, number):
    converter = front_end.converter
    return replace(front_end, converter=replace(converter, seed=(converter.seed + number) % (1 << 32)))


@pytest.mark.parametrize("mode, phase", MODE_CASES)
@pytest.mark.parametrize("stall", [0, 200])
def test_every_frame_is_the_golden_chips(mode, phase, stall):
    asked = asked_of("odd", mode=mode, phase=phase, threshold=3)
    front_end = front_end_of(asked.sensor, [7] * 24)
    program = hardware.program(asked.sensor)
    with hardware.chip(program, front_end, 4, stall) as chip:
        frames = [replace(asked.frame, frame_number=n, threshold=3 + n) for n in range(4)]
        several = [exposure(asked.sensor, n) for n in range(4)]
        sent = [chip.frame(frame, samples, front_end.trim) for frame, samples in zip(frames, several, strict=True)]
        for n, (frame, samples, wait) in enumerate(zip(frames, several, sent, strict=True)):
            golden, run = golden_frame(samples, asked.sensor, frame, numbered(front_end, n)), wait()
            assert run.stream == golden.stream
            assert run.status["conversions_made"] == golden.made
            assert run.activity["bytes"] == len(run.stream) and not run.status["cfg_err"]


def test_what_the_chip_has_is_not_written_again():
    asked = asked_of("odd", threshold=3)
    front_end = front_end_of(asked.sensor, [7] * 24)
    with hardware.chip(hardware.program(asked.sensor), front_end, 1) as chip:
        runs = [chip.frame(asked.frame, exposure(asked.sensor, 0)[:1], front_end.trim)() for _ in range(2)]
    assert len(runs[0].miso) - len(runs[1].miso) > 70  # bytes of the configuration
    assert runs[0].stream[:20] == runs[1].stream[:20] and runs[0].activity["busy"] == runs[1].activity["busy"]


@pytest.mark.needs("iverilog")
def test_icarus_runs_on_too(tmp_path):
    asked = asked_of("tile", threshold=3, exposure=1)  # by default 100,000 cycles pass before the first row
    rough = replace(asked.sensor, converter=ConverterParameters(inl=1, noise=1.5, ktc=1, seed=2**32 - 1))
    front_end = front_end_of(rough, [7] * 24)
    with hardware.chip(icarus_program(Build.of(rough), tmp_path), front_end, 1) as chip:
        for n in range(3):
            samples = exposure(rough, n)[:1]
            golden = golden_frame(samples, rough, asked.frame, numbered(front_end, n))
            assert chip.frame(asked.frame, samples, front_end.trim)().stream == golden.stream


def test_a_simulation_that_ends_is_an_error_in_one_line(tmp_path):
    asked = asked_of("odd")
    front_end = front_end_of(asked.sensor, [7] * 24)
    write_converter(tmp_path / "converter", front_end)
    program = hardware.program(asked.sensor)
    for converter, cycles, said in (("converter", 2000, "status 4 .no frame end."), ("none", 10**9, "cannot be read")):
        with (
            pytest.raises(ToolError, match=said),
            running(program, tmp_path / converter, 1, max_cycles=cycles) as bench,
        ):
            chip = hardware.Chip(bench)
            waits = [chip.frame(asked.frame, exposure(asked.sensor, 0)[:1], front_end.trim) for _ in range(3)]
            for wait in waits:
                wait()


def test_the_first_frame_is_that_of_a_picture_alone(tmp_path):
    codes = np.random.default_rng(1).integers(0, 256, (30, 45), np.uint8)
    Image.fromarray(codes).save(tmp_path / "a.png")
    asked = request(**SIZE, scene=str(tmp_path / "a.png"), threshold=3, views=5)
    alone = simulate_frame(asked)
    first, second = frames_of(asked, [codes, codes])
    assert first.stream == alone.stream == first.golden.stream
    assert second.stream == second.golden.stream and second.decoded.header.frame_number == 1
    np.testing.assert_array_equal(first.exposed.ideal, second.exposed.ideal)
    assert (first.decoded.samples != second.decoded.samples).mean() > 0.1  # noise of its own


@pytest.mark.parametrize("mode, phase", MODE_CASES)
def test_a_sequence_in_every_mode(mode, phase):
    asked = request(**SIZE, mode=mode, phase=phase, threshold=3, frame_number=65534)
    found, timing = frames_of(asked, pictures(4)), asked.frame.exposing
    assert [frame.decoded.header.frame_number for frame in found] == [65534, 65535, 0, 1]
    for frame in found:
        assert frame.stream == frame.golden.stream and frame.decoded.complete
        np.testing.assert_array_equal(frame.decoded.samples, frame.golden.sent)
        assert not frame.exposed.scene.speed and set(frame.chip.integrated) == {sum(integration_cycles(timing))}
    assert (timing.exposure > 0) == (mode != "tof")
    first, second, *_, last = (frame.chip.cycles for frame in found)  # a stream ends some cycles later
    assert first > second and abs(second - last) < 8  # one byte of frame_number is new


def test_views_are_chosen_again_where_a_picture_needs_more():
    dark, *rest = pictures(3)
    asked = request(rows=40, cols=48)
    found = frames_of(asked, [0 * dark, dark, *rest])
    views = [frame.exposed.views.most for frame in found]
    assert views[0] < views[1] == views[2]
    for frame in found:
        (region,) = frame.exposed.views.regions
        assert region.pixels.all() and frame.exposed.views.error <= 0.5


def test_a_consumer_may_stop_early():
    frames = results(request(**SIZE), open_clip(pictures(9), Sampling(13, 50)), Clock())
    assert next(frames).result.stream
    frames.close()
    assert decode_stream(
        next(results(request(**SIZE), open_clip(pictures(1), Sampling(13, 50)), Clock())).result.stream
    )
