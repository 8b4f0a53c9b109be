"""Rendered scenes: the files are those that the manifest knows, and are what the lens at hand sees, or say less."""

from dataclasses import replace
from hashlib import sha256

import numpy as np
import pytest
from scipy.constants import speed_of_light

from talbot.models.parameters import CameraParameters, ParameterError
from talbot.models.scene import LightField, Sampling, camera, load, read_light_field, write_light_field
from talbot.models.scene.echo import Echo
from talbot.models.scene.rendered import FOLDER, RENDERED, manifest

NAMES = list(RENDERED)


def own(name):
    size, lens = RENDERED[name]
    return Sampling(size, size, camera=lens)


def test_the_files_are_those_that_were_rendered():
    known = manifest()
    assert set(known) == set(RENDERED) == {path.stem for path in FOLDER.glob("*.npz")}
    for name, made in known.items():
        assert sha256((FOLDER / f"{name}.npz").read_bytes()).hexdigest() == made["sha256"], name
        assert made["samples"] >= 256 and f"SCENE={name}" in made["command"]
    assert sum(path.stat().st_size for path in FOLDER.glob("*.npz")) < 6e6


@pytest.mark.parametrize("name", NAMES)
def test_depth_and_disparity_are_of_one_lens(name):
    sampling = own(name)
    scene = load(name, sampling)
    assert scene.shape == sampling.shape and scene.full_light_field.shape == (5, 5, *sampling.shape)
    np.testing.assert_allclose(camera.disparity(scene.depth, sampling), scene.disparity, atol=2e-3)
    np.testing.assert_array_equal(scene.surfaces[2, 2], scene.disparity)
    assert 0.05 < scene.image.mean() < 0.9


@pytest.mark.parametrize("name", ["room", "plant", "spheres"])
def test_views_show_what_the_middle_one_shows_at_its_disparity(name):
    scene = load(name, own(name))
    y, x = np.indices(scene.shape)
    for v, u in ((2, 4), (0, 2), (1, 1)):
        d = scene.surfaces[v, u]
        at = np.rint(y + (v - 2) * d).astype(int), np.rint(x + (u - 2) * d).astype(int)
        inside = (np.array(at) >= 0).all(0) & (np.array(at) < scene.shape[0]).all(0)
        other = scene.surfaces[2, 2][at[0].clip(0, len(y) - 1), at[1].clip(0, len(x[0]) - 1)]
        assert (np.abs(other - d)[inside] < 0.05).mean() > 0.9  # the rest is hidden in one of the two
        same = inside & (np.abs(other - d) < 0.05)
        there = scene.image[at[0].clip(0, len(y) - 1), at[1].clip(0, len(x[0]) - 1)]
        moved = np.sqrt(np.mean((scene.light_field[v, u] - there)[same] ** 2))
        still = np.sqrt(np.mean((scene.light_field[v, u] - scene.image)[same] ** 2))
        assert moved < 0.7 * still


def test_a_part_is_the_middle_pixel_for_pixel():
    whole, part = load("room", own("room")), load("room", replace(own("room"), rows=40, cols=56))
    np.testing.assert_array_equal(part.light_field, whole.light_field[:, :, 28:68, 20:76])
    np.testing.assert_array_equal(part.depth, whole.depth[28:68, 20:76])
    wave = lambda z: np.cos(3 * z)  # noqa: E731
    one, other = (s.echo.returned(wave)(s.depth, s.disparity, 0, 0) for s in (whole, part))
    np.testing.assert_allclose(other, one[28:68, 20:76])


@pytest.mark.parametrize("change", [{"rows": 200}, {"camera": CameraParameters(f_number=2.0)}])
def test_enlarged_or_through_another_lens_there_is_no_depth(change):
    scene = load("room", replace(own("room"), **change))
    assert scene.depth is None and scene.echo is None and scene.disparity is not None


def test_what_stands_behind_is_behind():
    scene = load("plant", own("plant"))
    assert (scene.behind >= scene.depth - 1e-5).all() and 0.3 < (scene.behind > scene.depth + 0.5).mean() < 0.6


def test_polarization_of_the_sheet_is_that_of_the_formula():
    size, lens = RENDERED["sheet"]
    found, formula = (load(name, Sampling(size, size, camera=lens)) for name in ("sheet", "stress"))
    y, x = np.indices((size, size)) - (size - 1) / 2
    away = np.hypot(y, x) > 0.2 * size  # at the hole's edge a pixel is a mean
    error = np.hypot(*(found.seen_polarization - formula.polarization))[away]
    # Mitsuba's retarder turns its axis by up to 2.7 degrees in rays that are 3.6 degrees off the sheet's normal
    turned = np.hypot(*(found.seen_polarization[:, ::-1] - formula.polarization))[away]
    assert error.mean() < 0.06 and error.max() < 0.12 < 0.5 * turned.mean()


def test_highlights_are_polarized_across_the_plane_of_incidence():
    scene = load("spheres", own("spheres"))
    n, middle = 128, (64 * (1 - 0.35), 64 * (1 - 0.4))  # of the large ball
    y, x = np.indices((n, n)) + 0.5
    here = scene.specular & (np.hypot(y - middle[0], x - middle[1]) < 25)
    s1, s2 = scene.seen_polarization
    turned = np.arctan2(y - middle[0], x - middle[1]) + np.pi / 2 - np.arctan2(s2, s1) / 2
    away = np.abs((turned + np.pi / 2) % np.pi - np.pi / 2)[here]
    assert here.sum() > 100 and np.rad2deg(np.median(away)) < 8


def test_an_echo_of_one_late_bin_is_a_second_surface():
    echo = Echo(np.full((1, 1, 2, 3), 0.25), np.eye(4)[None, None, 2], 1.0, 0.5)
    wave = lambda z: np.cos(4 * np.pi * 1e8 / speed_of_light * z)  # noqa: E731
    seen = echo.returned(wave)(np.full((2, 3), 1.3), np.zeros((2, 3)), 0, 0)
    np.testing.assert_allclose(seen, 0.25 * wave(1.3) + 0.75 * wave(2.0))
    none = Echo(np.full((1, 1, 2, 3), 0.25), np.zeros((1, 1, 4)), 1.0, 0.5)
    np.testing.assert_allclose(none.returned(wave)(np.full((2, 3), 1.3), np.zeros((2, 3)), 0, 0), wave(1.3))


@pytest.mark.parametrize(
    "share, late, message",
    [
        (np.full((1, 1, 2, 3), 1.5), np.ones((1, 1, 4)), "out of range"),
        (np.full((1, 1, 2, 3), 0.5), -np.ones((1, 1, 4)), "out of range"),
        (np.full((1, 2, 3), 0.5), np.ones((1, 1, 4)), "must be 4-D and 3-D"),
    ],
)
def test_an_echo_that_cannot_be(share, late, message):
    with pytest.raises(ParameterError, match=message):
        Echo(share, late, 1.0, 0.5)


def test_an_echo_in_a_file(tmp_path):
    echo = Echo(np.full((1, 1, 8, 8), 0.25, np.float32), np.eye(4, dtype=np.float32)[None, None, 2], 1.0, 0.5)
    field = LightField(np.full((1, 1, 8, 8), 0.5), depth=np.ones((8, 8)), behind=2 * np.ones((8, 8)), echo=echo)
    write_light_field(field, tmp_path / "own.npz")
    again = read_light_field(tmp_path / "own.npz")
    np.testing.assert_array_equal(again.echo.late, echo.late)
    assert again.echo.bins[2] == 2.0 and again.behind.mean() == 2
    with pytest.raises(ParameterError, match="direct, late, bins together"):
        np.savez(tmp_path / "half.npz", light_field=field.values, late=echo.late)
        read_light_field(tmp_path / "half.npz")
