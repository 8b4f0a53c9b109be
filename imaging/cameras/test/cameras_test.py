"""Other cameras: frames of one exposure, the run with its page and tables, bad input."""

import json

import numpy as np
import pytest

from talbot.commands import main
from talbot.imaging.cameras import frames, job, measure, measurements, page
from talbot.models.capture import CaptureOperator, Region, cameras, integrate
from talbot.models.reconstruct import psnr_db
from talbot.models.scene import Sampling, load

SENSOR = measure.sensor_of(60)


@pytest.fixture
def coarse(monkeypatch):
    """One scene to learn from, three disparities of the prior."""
    monkeypatch.setattr(measure, "DISPARITIES", {"disparities": 3, "between": 0, "slants": 0})
    monkeypatch.setattr(measure, "CANDIDATES", (-1.0, 1.0))
    monkeypatch.setattr(measure, "TRAINING", ("coins",))
    monkeypatch.setattr(measure, "MARGIN", dict.fromkeys(measure.MARGIN, 0))


def _clean(name, scene):
    return frames.captured(scene, cameras.CAMERAS[name](SENSOR, 5))


def test_pixels_with_gratings_see_what_the_capture_sees():
    scene = load("tilted", Sampling.of(SENSOR))
    everywhere = Region(5, np.ones(scene.shape, bool))
    np.testing.assert_allclose(_clean("asp", scene), integrate(scene, SENSOR, everywhere)[0], atol=1e-3)
    clean = CaptureOperator(SENSOR).forward(np.asarray(scene.full_light_field))
    np.testing.assert_allclose(_clean("asp", scene), clean, atol=1e-9)


def test_all_cameras_have_one_exposure_and_their_own_light():
    scene, seconds = load("coins", Sampling.of(SENSOR)), frames.seconds_of(SENSOR, 500.0)
    bright, dim = (
        {name: frames.expose(SENSOR, name, _clean(name, scene), lux, seconds, 1) for name in cameras.CAMERAS}
        for lux in (500.0, 50.0)
    )
    assert all(frame.seconds == pytest.approx(seconds, rel=0.01) for frame in bright.values())
    assert all(dim[name].snr_db < bright[name].snr_db - 6 for name in cameras.CAMERAS)
    assert bright["asp"].bytes > 1.9 * bright["plain"].bytes
    assert bright["asp"].energy_uj > bright["plain"].energy_uj
    assert bright["lenslets"].noise < bright["mask"].noise < dim["mask"].noise
    for name, frame in bright.items():
        error = np.std(frame.samples - _clean(name, scene))
        assert error == pytest.approx(frame.noise, rel=0.4)  # one fixed pattern


def test_seeds_are_independent_chips():
    scene, seconds = load("coins", Sampling.of(SENSOR)), frames.seconds_of(SENSOR, 500.0)
    clean = _clean("plain", scene)
    first, again, other = (frames.expose(SENSOR, "plain", clean, 100.0, seconds, s).samples for s in (1, 1, 2))
    assert (first == again).all() and (first != other).mean() > 0.5


def test_the_disparity_is_that_of_the_scenes_it_is_learned_from(coarse):
    """Photographs are one pixel a view step behind the focal plane."""
    found = measure.learned(("coins",), 60, 500.0)
    assert found["disparity"] == -1.0 and len(found["psnr_db"]) == 2


@pytest.mark.parametrize("kind, tile, count", [p for p in measurements.points() if p[2] in (0.5, 2, 4)])
def test_measurements_are_as_many_as_they_say(kind, tile, count):
    camera = measurements.projection(kind, tile, count, SENSOR)
    read = camera.weights.any((1, 2))[camera.responses]
    assert read.sum(0).mean() == count
    period = camera.period
    assert period == ((4, 6) if tile == "regular" else measurements.PERIOD) and camera.block == (4, 6)
    assert len({tuple(pixel) for pixel in camera.order.reshape(camera.channels, -1).T}) > 8


@pytest.mark.slow
def test_more_measurements_give_better_views():
    """Of random projections, of a photograph."""
    few, every = (measurements.measured(("random", "regular", count), ("coins",))["psnr_db"] for count in (1, 4))
    assert every > few + 0.3


def test_a_run_has_a_page_tables_and_a_summary(coarse, tmp_path, capsys):
    marks = "".join(f"<!-- {name} -->\n<!-- end of {name} -->\n" for name in page.tables(False))
    document, out = tmp_path / "page.md", tmp_path / "out"
    document.write_text(marks)
    arguments = f"--scenes coins --size 60 --lux 50,500 --seeds 1 --out {out} --document {document}"
    assert main(["cameras", *arguments.split()]) == 0
    summary = json.loads((out / "summary.json").read_text())
    assert summary["lux"] == [500.0, 50.0] and len(summary["rows"]) == 2 * (4 * 4 + 2 + 1)
    assert {row["camera"] for row in summary["rows"]} == set(page.TEXTS)
    printed, text = capsys.readouterr().out, document.read_text()
    for name in page.TEXTS.values():
        assert name in printed and text.count(f"| {name} |") == 3
    assert "<svg" in (out / "cameras.html").read_text()
    plain = next(row for row in summary["rows"] if row["camera"] == "plain")
    assert plain["disparity_rms_px"] == pytest.approx(0, abs=0.05)  # it learned from the scene itself


def test_the_copied_image_is_the_baseline(coarse):
    rows = measure.measured("plain", ("coins",), 60, 500.0, 500.0, 1, -1.0)
    plain, copied = (next(row for row in rows if row["camera"] == name) for name in ("plain", "copied"))
    assert plain["psnr_db"] > copied["psnr_db"] + 3
    scene = load("coins", Sampling.of(SENSOR))
    truth = np.asarray(scene.full_light_field)
    blurred = _clean("plain", scene)[0]
    assert copied["psnr_db"] == pytest.approx(psnr_db(np.broadcast_to(blurred, truth.shape), truth), abs=0.3)


@pytest.mark.parametrize(
    "arguments, message",
    [
        ("--size 90", "size = 90: must be a multiple of 60"),
        ("--lux 0", "lux = '0': must be a number"),
        ("--scenes nothing", "scene = 'nothing': must be an image file"),
        ("--seeds 0", "seeds = '0': must be an integer"),
    ],
)
def test_bad_arguments_are_refused_in_a_line(arguments, message, capsys, tmp_path):
    assert main(["cameras", *arguments.split(), "--out", str(tmp_path / "out")]) == 2
    assert message in capsys.readouterr().err


def test_the_run_is_what_the_command_has_by_default():
    assert job.Comparison().scenes == measure.SCENES and job.Comparison().lux == measure.LUX
