"""The display's matrix against the capture of `models/capture`."""

from dataclasses import replace

import numpy as np
import pytest

from talbot.models.capture import Region, integrate
from talbot.models.parameters import STANDARD, ParameterError
from talbot.models.recognition.optics import VIEWS, Display, kernels, phase_types
from talbot.models.scene import Sampling, Scene
from talbot.models.scene.views import Shifted

RNG = np.random.default_rng(2)
PICTURES = (0.4 + 0.5 * RNG.random((2, 12, 10))).astype(np.float32)


def captured(display, picture, blur):
    """Photocurrents of the same plane by the project's capture."""
    rows, cols = display.size
    sensor = replace(STANDARD, array=replace(STANDARD.array, rows=rows, cols=cols))
    s, margin = display.scale, display.margin * display.scale
    shown = np.pad(np.kron(picture, np.ones((s, s))), margin)
    sampling = Sampling.of(sensor)
    disparity = -blur / sampling.views
    seen = Shifted(shown, disparity)
    flat = np.full(shown.shape, disparity)
    scene = Scene("plane", sampling.views, None, shown, flat, np.ones_like(flat), render=seen)
    return integrate(scene, sensor, Region(VIEWS, np.ones(shown.shape, bool)))[0]


@pytest.mark.parametrize(("scale", "blur"), ((2, 3.0), (3, -4.5)))
def test_currents_are_those_of_the_capture(scale, blur):
    """Exact inside; at the edge to the dark the capture cuts each view's undershoot off, the display their sum."""
    display = Display(STANDARD, (12, 10), scale, blur)
    got, truth = display.currents(PICTURES)[1], captured(display, PICTURES[1].astype(float), blur)
    edge = 2 * scale + int(abs(blur) / 2) + 3
    inside = np.s_[:, edge:-edge, edge:-edge]
    assert got[inside].size > 100 and np.abs(got - truth)[inside].max() < 1e-5
    assert np.abs(got - truth).max() < 0.05 * truth.max()


def test_kernels_of_a_focused_plane_are_the_types_weights_alone():
    k = kernels(STANDARD, 0.0)
    middle = k.shape[-1] // 2
    assert np.allclose(k.sum((2, 3)), k[:, :, middle, middle]) and k.sum((1, 2, 3)).mean() == pytest.approx(2)


def test_channels_of_a_linear_ramp_are_the_ramp():
    display = Display(STANDARD, (6, 6), 6, 0.0)
    rows, cols = display.size
    y, x = np.mgrid[:rows, :cols]
    got = display.channels((2.0 * y + x)[None], phase_types(STANDARD))[0]
    at = (np.arange(10) + 0.5) * 6 - 0.5
    inside = got[2:-2, 2:-2]
    assert np.allclose(inside, (2 * at[2:-2, None] + at[2:-2])[..., None], atol=1e-3) and got.shape == (10, 10, 12)


def test_the_first_layer_is_the_twelve_types_of_alpha_zero():
    kinds = phase_types(STANDARD)
    assert kinds.tolist() == list(range(0, 24, 2)) and {STANDARD.tile.types[k].alpha for k in kinds} == {0.0}


def test_what_does_not_fit_is_refused():
    with pytest.raises(ParameterError, match="scale = 32"):
        Display(STANDARD, (64, 64), 32)
    with pytest.raises(ParameterError, match="pictures"):
        Display(STANDARD, (5, 6)).currents(np.zeros((1, 6, 5)))
