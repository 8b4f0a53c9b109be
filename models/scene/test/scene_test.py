"""Scenes by name: shapes, types, ranges, and what their views must show."""

import numpy as np
import pytest

from talbot.models.parameters import CameraParameters, ParameterError
from talbot.models.scene import Sampling, Scene, load, scenes
from talbot.models.scene.rendered import RENDERED
from talbot.models.scene.test.focused import focused

OWN = [name for name in scenes if name not in RENDERED]  # whose views are as many as asked
SMALL = Sampling(rows=24, cols=36)


@pytest.mark.parametrize("name", OWN)
@pytest.mark.parametrize("dtype", ["float32", "float64"])
def test_every_scene_is_whole(name, dtype):
    scene = load(name, Sampling(rows=20, cols=30, dtype=dtype))
    assert scene.shape == (20, 30) and scene.full_light_field.shape == (5, 5, 20, 30)
    assert scene.light_field.dtype == dtype and scene.image.dtype == dtype
    np.testing.assert_allclose(scene.full_light_field[2, 2], scene.image, atol=1e-6)
    assert scene.depth.min() > 0


@pytest.mark.parametrize("name", OWN)
@pytest.mark.parametrize("shape", [(1, 1), (1, 40), (37, 1), (4, 5)])
@pytest.mark.parametrize("views", [1, 2, 5])
def test_extreme_shapes(name, shape, views):
    scene = load(name, Sampling(*shape, views=views))
    assert scene.full_light_field.shape == (views, views, *shape)


def test_motorcycle_disparity_and_depth_fit_the_calibration():
    scene = load("motorcycle", Sampling())
    assert 1.9 < 14.5 * scene.depth.min() < 2.3 and 4.5 < 14.5 * scene.depth.max() < 5.5
    assert -2.1 < scene.disparity.min() < -1.8 and 1.9 < scene.disparity.max() < 2.3
    near = scene.depth < 0.205
    assert (scene.disparity[near] > 0).all() and (scene.disparity[scene.depth > 0.209] < 0).all()


def test_motorcycle_focus_moves_the_focal_plane():
    default, shifted = (load("motorcycle", Sampling(48, 48, camera=CameraParameters(focus=f))) for f in (0.207, 0.19))
    # f**2 / N / (views pitch) px for each 1/m
    step = 7.96e-3**2 / 1.2 / 5 / 10e-6 * (1 / 0.19 - 1 / 0.207)
    np.testing.assert_allclose(shifted.disparity, default.disparity - step)
    np.testing.assert_array_equal(shifted.depth, default.depth)


def test_edge_moves_between_views_by_its_disparity():
    scene = load("edge:0", focused(Sampling(9, 41), -2.0))
    crossing = [np.interp(0.5, scene.light_field[2, u, 4], np.arange(41.0)) for u in range(5)]
    # l[v, u](x) = I(x + du * d) with d = -2: the edge moves by +2 px a view step.
    np.testing.assert_allclose(np.diff(crossing), 2.0, atol=1e-6)


def test_in_focus_plane_keeps_one_view():
    scene = load("edge:30", focused(Sampling(9, 41), 0.0))
    assert not scene.angular and scene.light_field.shape == (1, 1, 9, 41)
    np.testing.assert_array_equal(scene.full_light_field[0, 4], scene.image)


def test_tilted_plane_obeys_its_own_disparity():
    scene = load("tilted", Sampling(32, 64))
    x = np.arange(64.0)
    d = scene.disparity[16]
    # A texture position x of the centre view is at x - du d(x) in view u.
    seen = np.interp(x - 2 * d, x, scene.light_field[2, 4, 16])
    assert np.abs(seen - scene.image[16])[8:-8].max() < 0.01


@pytest.mark.parametrize("name,value", [("black", 0.0), ("saturated", 8.0), ("flat", 0.5), ("flat:10", 0.1)])
def test_uniform_targets(name, value):
    scene = load(name, SMALL)
    assert not scene.angular and (scene.image == value).all()


def test_polarized_target_has_its_degree():
    scene = load("polarized:40", SMALL)
    np.testing.assert_allclose(np.hypot(*scene.polarization), 0.4)


@pytest.mark.parametrize(
    "name,field",
    [
        ("nothing", "scene"),
        ("edge:north", "edge degrees"),
        ("edge:1e9", "edge degrees"),
        ("flat:nan", "flat percent"),
        ("missing/file.png", "scene"),
        ("coins:3", "scene"),
    ],
)
def test_bad_names(name, field):
    with pytest.raises(ParameterError, match=field):
        load(name, SMALL)


def test_depth_file_beside_a_named_scene_is_refused():
    with pytest.raises(ParameterError, match="depth"):
        load("motorcycle", SMALL, depth="d.npy")


def _scene(**changes):
    image = np.full((4, 6), 0.5)
    return Scene(**{"name": "t", "views": 3, "field": np.full((3, 3, 4, 6), 0.5), "image": image, **changes})


@pytest.mark.parametrize(
    "changes,field",
    [
        ({"field": np.full((3, 3, 4), 0.5)}, "light_field shape"),
        ({"field": np.full((5, 5, 4, 6), 0.5)}, "light_field shape"),
        ({"field": np.full((3, 3, 4, 6), np.nan)}, "light_field = nan"),
        ({"field": np.full((3, 3, 4, 6), np.inf)}, "light_field = inf"),
        ({"field": np.full((3, 3, 4, 6), -0.1)}, "light_field = -0.1"),
        ({"field": np.full((3, 3, 4, 6), 1)}, "light_field dtype"),
        ({"image": np.full((4, 5), 0.5)}, "image shape"),
        ({"depth": np.zeros((4, 6))}, "depth = 0"),
        ({"polarization": np.full((2, 4, 6), 0.9)}, "degree of polarization"),
        ({"views": 0}, "views"),
    ],
)
def test_bad_scenes(changes, field):
    with pytest.raises(ParameterError, match=field):
        _scene(**changes)


@pytest.mark.parametrize(
    "changes", [{"rows": 0}, {"cols": 2000}, {"views": 32}, {"dtype": "int8"}, {"pitch": float("nan")}, {"rows": 2.5}]
)
def test_bad_samplings(changes):
    with pytest.raises(ParameterError, match=next(iter(changes))):
        Sampling(**changes)


def test_a_stressed_sheet_in_two_wavelengths_has_their_mean():
    """Retardance falls with the wavelength; the light that is left polarized adds up."""
    lines = ((550e-9, 1.0),), ((450e-9, 1.0),), ((550e-9, 0.3), (450e-9, 0.7))
    own, blue, both = (load("stress", Sampling(24, 30, light=light)).polarization for light in lines)
    np.testing.assert_allclose(load("stress", Sampling(24, 30)).polarization, own)
    np.testing.assert_allclose(both, 0.3 * own + 0.7 * blue)
    assert np.abs(own - blue).max() > 0.1
