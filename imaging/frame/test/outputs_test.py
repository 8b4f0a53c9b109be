"""The page of a frame: error maps are the figures' errors, scales hold the values, words are those of the mode."""

import subprocess
import sys

import numpy as np
import pytest

from talbot.imaging.frame import job, outputs, report
from talbot.imaging.frame.figures import summarize_golden
from talbot.imaging.frame.quality import depth_error, depth_map
from talbot.imaging.frame.request import request
from talbot.models.parameters import CameraParameters, OpticsParameters, SensorParameters

SMALL = {"rows": 16, "cols": 24}


def frame(mode, **more):
    result = job.golden_result(request(**SMALL, mode=mode, **more))
    return result, summarize_golden(result)


@pytest.fixture(scope="module")
def far():
    """Time of flight of the scene in life size."""
    camera = CameraParameters(focus=3.0, scale=1.0)
    return frame("tof", sensor=SensorParameters(optics=OpticsParameters(camera=camera)))


def test_depth_has_a_scale_in_metres_and_its_error(far):
    result, summary = far
    shown = {p.name: p for p in (*outputs.shown(result, summary), *outputs.error_maps(result, summary))}
    truth = result.exposed.scene.depth
    assert shown["depth"].scale.low < truth.min() and truth.max() < shown["depth"].scale.high
    assert shown["depth"].scale.unit == shown["depth_error"].scale.unit == "m"
    error = depth_error(result)
    assert np.sqrt(np.nanmean(error**2)) == pytest.approx(summary["depth_rms_m"])
    # the colour of a pixel is that of its depth on the bar
    row, col = 8, 12
    scale, colour = shown["depth"].scale, np.asarray(shown["depth"].image)[row, col]
    at = np.abs(scale.colours.astype(int) - colour).sum(1).argmin()
    found = scale.low + at / 255 * (scale.high - scale.low)
    assert found == pytest.approx(depth_map(result)[row, col], abs=(scale.high - scale.low) / 255)


@pytest.mark.parametrize("mode, maps", [("edge", ["differences", "image"]), ("image", ["image"]), ("raw", ["image"])])
def test_pictures_have_the_errors_of_the_mode(mode, maps):
    result, summary = frame(mode)
    names = [picture.name for picture in outputs.shown(result, summary)]
    found = outputs.error_maps(result, summary)
    assert [picture.title for picture in found] == maps and set(maps) <= set(names)
    assert all(picture.scale.low == -picture.scale.high for picture in found)
    assert {picture.name for picture in found} <= set(outputs.PICTURES)


def test_every_view_of_a_light_field_and_its_error_are_in_the_slider():
    result, summary = frame("raw")
    fields = outputs._fields(result, summary)
    scene, estimate = (field.mean() for _, field in fields)
    assert estimate == pytest.approx(scene, rel=0.2)  # as bright
    views = outputs._views(fields)
    n = result.exposed.scene.views
    assert [v.columns for v in views] == [n, n, n] and n == 5
    assert {v.sprite.size for v in views} == {(n * 24, n * 16)}
    field = result.exposed.scene.full_light_field
    corner = np.asarray(views[0].sprite)[:16, :24]
    assert np.corrcoef(corner.ravel(), field[0, 0].ravel() ** (1 / 2.2))[0, 1] > 0.99 or not field[0, 0].any()


@pytest.mark.parametrize("mode", ["edge", "raw"])
def test_words_of_the_bytes(mode):
    _, summary = frame(mode)
    assert list(summary["bytes"]) == ["header", "samples", "marks", "trailer"]
    assert sum(summary["bytes"].values()) == summary["stream_bytes"]
    assert report.FIRST[-1] == "image"


def test_a_frame_is_prepared_without_numba_and_scipy():
    """Both import for longer than a frame takes whose results are kept."""
    program = "import sys, talbot.imaging.frame.job, talbot.imaging.frame.outputs; print(*sys.modules)"
    out = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout.split()
    assert "numpy" in out
    assert not {"numba", "scipy", "skimage", "matplotlib", "joblib"} & {*out}
