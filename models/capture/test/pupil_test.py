"""The integral over the pupil: against an independent one of 31 x 31 rays, behind three lenses, and off the axis."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from PIL import Image

from talbot.models.afe import FrontEnd, trim_codes
from talbot.models.capture import CaptureOperator, Exposure, Region, capture, choose_views, integrate
from talbot.models.capture.pupil import cells
from talbot.models.parameters import (
    AmpTiming,
    ArrayParameters,
    CameraParameters,
    FrameParameters,
    OpticsParameters,
    ParameterError,
    SensorParameters,
)
from talbot.models.pixel import measured_gains, optical_gains
from talbot.models.pixel.weights import raw_weights
from talbot.models.plan import codes_per_unit, plan
from talbot.models.scene import Sampling, load
from talbot.models.scene.views import Pictured

ROWS, COLS = 24, 36
LENSES = {"default": (1.2, 0.207), "slower": (2.0, 0.18), "farther": (2.8, 0.26)}  # f-number, focus
PICTURES = ("coins", "text", "chelsea", "rocket")


def sensor_behind(rows=ROWS, cols=COLS, **lens):
    return SensorParameters(array=ArrayParameters(rows, cols), optics=OpticsParameters(CameraParameters(**lens)))


def shift(size, by):
    """Matrix that samples a row of pixels ``by`` px to the right, by cubic convolution, the border repeated."""
    out = np.zeros((size, size))
    for x in range(size):
        place = min(max(x + by, 0), size - 1)
        first = int(place)
        t = place - first
        taps = (
            -0.5 * t * (1 - t) ** 2,
            1 - 2.5 * t**2 + 1.5 * t**3,
            0.5 * t + 2 * t**2 - 1.5 * t**3,
            0.5 * t**2 * (t - 1),
        )
        for i, tap in enumerate(taps):
            out[x, min(max(first + i - 1, 0), size - 1)] += tap
    return out


def rays(name, scene, sensor, f_number, focus):
    """(tangent y, tangent x, radiance) of 31 x 31 rays in the pupil, from the scene's depth and the lens alone."""
    lens = sensor.optics.camera
    per_tangent = lens.focal_length**2 / sensor.array.pitch * (1 / scene.depth - 1 / focus)  # px of the sensor
    tangents = ((np.arange(31) + 0.5) / 31 - 0.5) / f_number
    if name == "motorcycle":  # its occlusions are the scene's own
        field = load(name, replace(Sampling.of(sensor), views=31)).light_field
        return [(v, u, field[j, i]) for j, v in enumerate(tangents) for i, u in enumerate(tangents)]
    if name == "tilted":
        y, x = np.mgrid[:ROWS, :COLS] - np.array([ROWS - 1, COLS - 1])[:, None, None] / 2
        slope = (per_tangent[0, -1] - per_tangent[0, 0]) / (COLS - 1)
        k, out = 2 * np.pi / 24, []
        for v in tangents:
            for u in tangents:
                seen = x
                for _ in range(60):  # where the ray meets the plane: what is seen at x + u d is at disparity d
                    d = per_tangent[0, 0] + slope * (seen - x[0, 0])
                    seen = x + u * d
                rows = y + v * d
                out.append((v, u, 0.5 + 0.15 * (np.sin(k * seen) + np.sin(k * rows) + np.sin(0.7 * k * (seen + rows)))))
        return out
    d = per_tangent[0, 0]
    down, right = ({t: shift(n, t * d) for t in tangents} for n in (ROWS, COLS))
    return [(v, u, np.clip(down[v] @ scene.image @ right[u].T, 0, None)) for v in tangents for u in tangents]


def independent(name, scene, sensor, f_number, focus):
    """Differences in codes, (rows, cols): Eq. 3.1 and 3.3 written out, each ray's cell sampled at 12 x 12 points."""
    types, optics = sensor.tile.types, sensor.optics
    fine = ((np.arange(12) + 0.5) / 12 - 0.5) / 31 / f_number
    weights = np.zeros((24, 2))
    pairs = np.zeros((24, 2, ROWS, COLS))
    for v, u, light in rays(name, scene, sensor, f_number, focus):
        y, x = v + fine[:, None], u + fine[None, :]
        inside = np.hypot(y, x) <= 1 / (2 * f_number)
        if not inside.any():
            continue
        ty, tx = np.arctan(y), np.arctan(x)
        common = inside * np.exp(-(ty**2 + tx**2) / (2 * optics.aperture_sigma**2)) / (1 + y**2 + x**2) ** 2
        for t, kind in enumerate(types):
            wave = optics.m * np.cos(kind.beta * (tx * np.cos(kind.gamma) + ty * np.sin(kind.gamma)) + kind.alpha)
            ray = np.array([(common * (1 + wave)).sum(), (common * (1 - wave)).sum()])
            weights[t] += ray
            pairs[t] += ray[:, None, None] * light
    kinds = sensor.tile.type_map(ROWS, COLS)
    electrons = 0.25e-9 * 51.2e-6 / 1.602176634e-19
    a, b = (electrons * np.take_along_axis(pairs[:, d], kinds[None], 0)[0] / weights.mean() for d in (0, 1))
    ratio = np.clip(np.rint(weights[:, 0] / weights[:, 1] * 512), 0, 1023) / 512  # the trim register's range
    return 4.0 / (2e5 / 255) * (np.minimum(a, 1e5) - ratio[kinds] * np.minimum(b, 1e5))


FAST = [*(("motorcycle", lens) for lens in LENSES), ("tilted", "default"), (PICTURES[0], "default")]
MORE = [case for case in product(("tilted", *PICTURES), LENSES) if case not in FAST]


@pytest.mark.parametrize("name, lens", [*FAST, *(pytest.param(*case, marks=pytest.mark.slow) for case in MORE)])
def test_differences_are_those_of_an_independent_camera(name, lens):
    f_number, focus = LENSES[lens]
    sensor = sensor_behind(f_number=f_number, focus=focus)
    scene, frame = load(name, Sampling.of(sensor)), FrameParameters(sensor.full_window)
    views = choose_views(scene, sensor, frame.timing)
    samples = capture(
        scene,
        sensor,
        plan(scene, sensor, frame),
        Exposure(sensor.electrical, frame.timing, noise=0),
        regions=views.regions,
    )
    trims = tuple(trim_codes(optical_gains(sensor.tile, sensor.optics)).tolist())
    found = FrontEnd(sensor.electrical.difference_gain, trims).values(samples, "edge")[0]
    expected = independent(name, scene, sensor, f_number, focus)
    error = np.sqrt(np.mean((found - expected) ** 2))
    assert error < 0.5 and views.error < 0.5
    assert expected.std() > 1


def test_the_scene_s_own_grid_is_the_operator():
    sensor = sensor_behind()
    scene = load("motorcycle", Sampling.of(sensor))
    found = integrate(scene, sensor, Region(5, np.ones(scene.shape, bool)))[0]
    np.testing.assert_allclose(found, CaptureOperator(sensor).forward(scene.light_field), atol=1e-6)


def test_regions_add_up():
    sensor = sensor_behind()
    scene = load("coins", Sampling.of(sensor))
    left = np.zeros(scene.shape, bool)
    left[:, :17] = True
    whole = integrate(scene, sensor, Region(9, left | ~left))
    parts = integrate(scene, sensor, Region(9, left)) + integrate(scene, sensor, Region(9, ~left))
    np.testing.assert_allclose(parts, whole, atol=1e-12)


def test_fewer_views_err_more():
    sensor, timing = sensor_behind(f_number=1.2), FrameParameters(sensor_behind().full_window).timing
    scene = load("motorcycle", Sampling.of(sensor))
    errors = [choose_views(scene, sensor, timing, views).error for views in (3, 7, 15)]
    assert errors[0] > 2 * errors[1] > 2 * errors[2] > 0
    chosen = choose_views(scene, sensor, timing, bound=0.2)
    assert chosen.error <= 0.2 and chosen.most > choose_views(scene, sensor, timing, bound=2.0).most


def test_the_error_is_that_of_all_pixels(tmp_path):
    """A picture with texture in its last rows alone."""
    codes = np.full((96, 96), 128, np.uint8)
    codes[84:] = np.random.default_rng(0).integers(0, 256, (12, 96), np.uint8)
    Image.fromarray(codes).save(tmp_path / "p.png")
    sensor = sensor_behind(96, 96)
    scene, timing = load(str(tmp_path / "p.png"), Sampling.of(sensor)), FrameParameters(sensor.full_window).timing
    views = choose_views(scene, sensor, timing)
    gains = optical_gains(sensor.tile, sensor.optics)[sensor.tile.type_map(96, 96)]

    def differences(regions):
        a, b = sum(integrate(scene, sensor, region)[0] for region in regions)
        return codes_per_unit(sensor, timing) * (a - gains * b)

    apart = differences(views.regions) - differences([Region(31, np.ones((96, 96), bool))])
    assert np.sqrt(np.mean(apart**2)) == pytest.approx(views.error, rel=1e-6)
    assert 0.05 < views.error < 0.5


@pytest.mark.parametrize(
    "name, size",
    [
        ("rocket", (384, 576)),
        pytest.param("motorcycle", (192, 288), marks=pytest.mark.slow),
        pytest.param("motorcycle", (384, 576), marks=pytest.mark.slow),
    ],
)
def test_some_tile_rows_have_the_error_of_all(monkeypatch, name, size):
    sensor = sensor_behind(*size)
    timing = FrameParameters(sensor.full_window).timing
    scene = load(name, Sampling.of(sensor))
    few = choose_views(scene, sensor, timing, 7).error
    monkeypatch.setattr("talbot.models.capture.views.PROBE", sensor.tile_rows)
    whole = choose_views(scene, sensor, timing, 7).error
    assert few != whole and few == pytest.approx(whole, rel=0.05)


def test_rows_that_are_not_measured_keep_the_bound(tmp_path):
    """A zone plate: its detail changes from row to row."""
    y, x = np.mgrid[:500, :500] - 250
    Image.fromarray((255 * (0.5 + 0.45 * np.cos((x**2 + y**2) / 700))).astype(np.uint8)).save(tmp_path / "p.png")
    sensor = sensor_behind(384, 48)
    scene, timing = load(str(tmp_path / "p.png"), Sampling.of(sensor)), FrameParameters(sensor.full_window).timing
    gains = optical_gains(sensor.tile, sensor.optics)[sensor.tile.type_map(384, 48)]
    views = choose_views(scene, sensor, timing)
    a, b = sum(integrate(scene, sensor, region)[0] for region in views.regions)
    a -= (every := integrate(scene, sensor, Region(31, np.ones((384, 48), bool)))[0])[0]
    apart = codes_per_unit(sensor, timing) * (a - gains * (b - every[1]))
    assert views.error < np.sqrt(np.mean(apart**2)) < 0.5


def test_in_focus_little_is_rendered(tmp_path):
    """A picture whose left half is in the focal plane, and whose right half stands behind it."""
    codes = np.random.default_rng(0).integers(0, 256, (96, 96), np.uint8)
    Image.fromarray(codes).save(tmp_path / "p.png")
    np.save(tmp_path / "d.npy", np.where(np.arange(96) < 48, 3.0, 3.6) * np.ones((96, 1)))
    sensor = sensor_behind(96, 96, focus=3 / 14.5)
    scene = load(str(tmp_path / "p.png"), Sampling.of(sensor), tmp_path / "d.npy")
    views = choose_views(scene, sensor, FrameParameters(sensor.full_window).timing)
    few = min(views.regions, key=lambda region: region.views).pixels
    assert len(views.regions) == 2 and views.left_out and views.error < 0.5
    assert few[:, :42].mean() > 0.9 and few[:, 54:].mean() < 0.5


def test_the_pupil_is_round():
    assert cells(1).sum() == 1 and cells(5).sum() == 25 and cells(31).sum() == 801
    assert cells(101).mean() == pytest.approx(np.pi / 4, abs=0.03)


@pytest.mark.parametrize("pupil", [0.05, 0.01])
def test_chief_rays_reach_every_pixel(pupil):
    """Flat white: each pixel against its own integral, with the pupil where the pixel sees it."""
    sensor = sensor_behind(96, 96, exit_pupil=pupil)
    scene = load("flat:100", Sampling.of(sensor))
    found = integrate(scene, sensor, Region(1, np.ones(scene.shape, bool)))[0]
    optics = replace(sensor.optics, views=1, subsamples=40)
    scale = 2 / raw_weights(sensor.tile.types, optics).sum((1, 2, 3)).mean()
    for y, x in ((0, 0), (95, 3), (47, 80)):
        chief = ((y - 47.5) * 10e-6 / pupil, (x - 47.5) * 10e-6 / pupil)
        own = raw_weights(sensor.tile.types, optics, chief)[sensor.tile.type_map(96, 96)[y, x]].sum((1, 2)) * scale
        np.testing.assert_allclose(found[:, y, x], own, rtol=2e-4)


def test_one_trim_a_type_nulls_a_telecentric_flat_field_alone():
    """The spread of a flat white's differences, in codes, over the array."""
    spread = {}
    for pupil in (None, 0.05):
        sensor = sensor_behind(384, 384, exit_pupil=pupil)
        pair = integrate(load("flat:100", Sampling.of(sensor)), sensor, Region(1, np.ones((384, 384), bool)))[0]
        gains = measured_gains(np.moveaxis(pair, 0, -1), sensor.tile)[sensor.tile.type_map(384, 384)]
        spread[pupil] = float(np.abs(4 * 101.9 * (pair[0] - gains * pair[1])).max())
    assert spread[None] < 1e-9 and spread[0.05] > 4


def test_impossible_views():
    sensor = sensor_behind()
    scene = load("coins", Sampling.of(sensor))
    for arguments, field in (({"views": 32}, "views"), ({"bound": 0.0}, "bound")):
        with pytest.raises(ParameterError, match=field):
            choose_views(scene, sensor, FrameParameters(sensor.full_window).timing, **arguments)


def test_light_that_the_middle_view_does_not_see():
    """None where the views are those of the middle one, some between leaves, unknown of a photograph"""
    sensor = SensorParameters(array=ArrayParameters(48, 48))
    leaves, coins = (load(name, Sampling.of(sensor)) for name in ("leaves:7", "coins"))
    seen = Pictured(leaves.image, leaves.disparity, Sampling.of(sensor))
    alone = replace(leaves, field=None, render=lambda mask: seen(mask))
    hidden = [choose_views(scene, sensor, AmpTiming(), 7).hidden for scene in (alone, leaves, coins)]
    assert hidden[0] < 1e-9 and hidden[1] > 0.5 and hidden[2] is None
