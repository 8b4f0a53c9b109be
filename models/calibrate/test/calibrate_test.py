"""Types, aperture and chief ray from synthetic sweeps, and quantities that cannot be determined."""

import json
from dataclasses import replace

import numpy as np
import pytest

from talbot.models.calibrate import Calibration, Sweep, block_means, calibrated, fit_pupil, fit_types, read_calibration
from talbot.models.calibrate.table import Samples, tables
from talbot.models.parameters import OpticsParameters, ParameterError, SensorParameters, TileParameters
from talbot.models.pixel.weights import density

TILE, PITCH = TileParameters(), 1e-5
SIDE = np.linspace(-0.38, 0.38, 13)
HOLES = np.stack([g.ravel() for g in np.meshgrid(SIDE, SIDE, indexing="ij")], 1)
HOLES = HOLES[np.hypot(*HOLES.T) <= 0.39]
OPTICS = OpticsParameters()


def swept(optics=OPTICS, slope=0.0, centre=(0.0, 0.0), noise=0.1, size=48):
    """Sweep of an array of ``size`` pixels; slope: of the chief ray's tangent, 1/px; noise in codes a pixel."""
    places = np.stack(np.meshgrid(*[np.arange(size) - (size - 1) / 2] * 2, indexing="ij"), -1)
    kinds, random = TILE.type_map(size, size), np.random.default_rng(3)
    diodes = np.empty((len(HOLES), size, size, 2))
    for i, hole in enumerate(HOLES):
        y, x = np.moveaxis(hole + slope * (places - centre), -1, 0)
        for number, kind in enumerate(TILE.types):
            own = kinds == number
            diodes[i, own] = 100 * density((kind,), optics, x[own], y[own])[0].T
    diodes += random.normal(0, noise, diodes.shape)
    means = np.stack([block_means(frame, TILE) for frame in diodes])
    return Sweep(HOLES, means, block_means(places, TILE), np.ones(TILE.n_types))


def test_what_was_put_in():
    found, pupil, fits = calibrated(swept(), PITCH)
    assert pupil.sigma == pytest.approx(0.2, abs=1e-3) and pupil.condition < 20
    assert found.pupil_power == 0 and found.centre is None
    for fit, true in zip(fits, TILE.types, strict=True):
        assert fit.kind.beta == pytest.approx(true.beta, abs=0.02)
        assert fit.kind.gamma_deg == pytest.approx(true.gamma_deg, abs=0.1)
        assert fit.kind.alpha == pytest.approx(true.alpha, abs=2e-3)
        assert fit.kind.m == pytest.approx(0.7, abs=2e-3) and fit.condition < 2
    known = found.applied(SensorParameters(tile=TILE))
    assert known.tile.types == found.types and known.optics.camera.exit_pupil is None


def test_errors_are_what_they_say():
    many = [fit_types(s := swept(noise=5.0, size=24), fit_pupil(s))]
    wrong = [[(fit.kind.m - 0.7) / fit.m_error for fit in fits] for fits in many]
    for name in ("beta", "gamma_deg"):
        error = name.removesuffix("_deg") + "_error"
        pairs = [zip(fits, TILE.types, strict=True) for fits in many]
        wrong += [[(getattr(f.kind, name) - getattr(t, name)) / getattr(f, error) for f, t in pair] for pair in pairs]
    for part in np.array(wrong):
        assert 0.3 < np.sqrt((part**2).mean()) < 2


def test_readings_that_are_missing():
    """A type that was not read at some of the places, as where it saturates, is fitted to the others."""
    sweep = swept(size=12)
    diodes = sweep.diodes.copy()
    diodes[::3, :, 7] = np.nan
    fit = calibrated(replace(sweep, diodes=diodes), PITCH, centred=True)[2][7]
    assert fit.kind.beta == pytest.approx(TILE.types[7].beta, abs=0.05) and fit.kind.m == pytest.approx(0.7, abs=0.01)


def test_angles_whose_zero_is_that_of_the_holes():
    """The sums have their own zero, and it is reported; the waves' is that of the holes where these are trusted."""
    sweep = swept(size=12)
    moved = replace(sweep, holes=sweep.holes - [0.0, 0.02])
    (_, pupil, fits), (_, _, others) = (calibrated(moved, PITCH, centred=centred) for centred in (True, False))
    assert pupil.axis == pytest.approx([0, 0.02], abs=1e-3)
    kind = TILE.types[16]  # beta 24 along x
    assert fits[16].kind.alpha == pytest.approx(kind.alpha + 24 * 0.02, abs=0.03)
    assert others[16].kind.alpha == pytest.approx(kind.alpha, abs=0.03)


def test_chief_ray_and_optical_centre():
    found, pupil, fits = calibrated(swept(slope=8e-4, centre=(4.0, -3.0)), PITCH)
    assert found.pupil_power == pytest.approx(80, rel=0.01)
    assert found.centre == pytest.approx((4.0, -3.0), abs=0.2)
    error = [fit.kind.alpha - true.alpha for fit, true in zip(fits, TILE.types, strict=True)]
    assert np.abs(error).max() < 0.02
    blind = fit_types(swept(slope=8e-4), pupil._replace(slope=0.0))  # the wave is washed out by a mean over the array
    lost, rest = (0.7 - np.mean([fit.kind.m for fit in some]) for some in (blind, fits))
    assert lost > 0.01 > 5 * abs(rest)


@pytest.mark.parametrize("m", [0.0, 1.0])
def test_extremes_of_the_modulation(m):
    fits = calibrated(swept(OpticsParameters(m=m), size=24), PITCH)[2]
    found = np.array([fit.kind.m for fit in fits])
    np.testing.assert_allclose(found, m, atol=5e-3)
    assert all(fit.alpha_error == np.pi and fit.kind.beta == 0 for fit in fits) == (m == 0)


def test_a_missing_type_has_no_modulation():
    sweep = swept(size=24)
    diodes, places = sweep.diodes.copy(), sweep.places.copy()
    diodes[:, :, 5], places[:, 5] = np.nan, np.nan
    found, _, fits = calibrated(replace(sweep, diodes=diodes, places=places), PITCH)
    assert fits[5].kind.m == 0 and fits[5].alpha_error == np.pi and fits[4].kind.m == pytest.approx(0.7, abs=0.01)
    assert Calibration.of(found.table) == found


def test_no_light():
    sweep = swept(size=24)
    with pytest.raises(ParameterError, match="must have light"):
        calibrated(replace(sweep, diodes=0 * sweep.diodes), PITCH)


def test_files(tmp_path):
    found = calibrated(swept(size=24), PITCH)[0]
    for bad in ('{"types": []}', "[" * 100_000):
        (tmp_path / "bad.json").write_text(bad)
        with pytest.raises(ParameterError, match="bad.json': must be a calibration.json"):
            read_calibration(tmp_path / "bad.json")
    for name in ("none.json", "", "/dev/zero"):
        with pytest.raises(ParameterError, match=f"{name}': must be a calibration.json"):
            read_calibration(tmp_path / name)
    with pytest.raises(ParameterError, match="calibration = 24 pixel types: must be 4"):
        found.applied(SensorParameters(tile=TileParameters.small(2, 2)))
    with pytest.raises(ParameterError, match="sigma = 0: must be"):
        replace(found, sigma=0)


def own(kind):
    """A response that is none of Eq. 3.1: a sharp resonance added to the wave, another level."""
    level = 1.3 if kind.beta < 15 else 0.8

    def rho(theta_x, theta_y):
        turned = theta_x * np.cos(kind.gamma) + theta_y * np.sin(kind.gamma)
        across = theta_y * np.cos(kind.gamma) - theta_x * np.sin(kind.gamma)
        q = 0.5 * np.cos(kind.beta * turned + kind.alpha) + 0.3 / (1 + ((turned - 0.1 - across**2) / 0.03) ** 2)
        return level * np.stack([1 + q, 1 - q]) * np.exp(-12.5 * (theta_x**2 + theta_y**2))

    return rho


@pytest.mark.slow
def test_responses_that_are_not_of_the_formula(tmp_path):
    """Tables leave a quarter of what Eq. 3.1 leaves, at angles between the samples, and survive their file."""
    tile = replace(TILE, types=tuple(replace(kind, response=own(kind)) for kind in TILE.types))
    count = np.arange(133) + 0.5
    holes = 0.38 * np.sqrt(count / 133)[:, None] * np.stack([np.sin(2.4 * count), np.cos(2.4 * count)], 1)
    light = density(tile.types, OPTICS, holes[:, 1], holes[:, 0])  # (types, 2, n)
    noise = np.random.default_rng(5).normal(0, 2e-3, light.shape)
    sweep = Sweep(holes, (light + noise).transpose(2, 0, 1)[:, None], np.zeros((1, TILE.n_types, 2)), np.ones(24))
    found, pupil, fits = calibrated(sweep, PITCH)
    path = tmp_path / "calibration.json"
    path.write_text(json.dumps(found.table))
    read = read_calibration(path)

    random = np.random.default_rng(6).uniform(-0.26, 0.26, (2, 500))
    true = density(tile.types, OPTICS, *random)
    levels = true.mean((1, 2)) / true.mean()

    def error(calibration, types=None):
        sensor = calibration.applied(SensorParameters(tile=TILE))
        got = density(types or sensor.tile.types, sensor.optics, *random)
        q = [(of[:, 0] - of[:, 1]) / of.sum(1) for of in (got, true)]
        return np.sqrt(np.mean((q[0] - q[1]) ** 2)), got.mean((1, 2)) / got.mean()

    formula = error(found, tuple(replace(kind, response=None) for kind in found.types))[0]
    for calibration in (found, read):
        rms, level = error(calibration)
        assert rms < formula / 4 and formula > 0.05
        np.testing.assert_allclose(level, levels, rtol=0.01)
    assert all(kind.response is None for kind in calibrated(swept(size=24), PITCH)[0].types)


def test_a_residual_that_is_all_noise_leaves_the_formula():
    kind = replace(TILE.types[0], m=0.7)
    random = np.random.default_rng(7)
    theta = random.uniform(-0.3, 0.3, (133, 2))
    q = 0.7 * np.cos(kind.beta * np.arctan(np.tan(theta[:, 1])) + kind.alpha)
    diodes = np.stack([1 + q, 1 - q], 1) + random.normal(0, 0.2, (133, 2))
    (found,) = tables([kind], [Samples(theta, diodes, np.ones(133))], 0.2)
    x = np.linspace(-0.25, 0.25, 101)
    a, b = found.response(x, 0 * x)
    rest = (a - b) / (a + b) - 0.7 * np.cos(kind.beta * x + kind.alpha)
    assert np.sqrt(np.mean(rest**2)) < 0.06
