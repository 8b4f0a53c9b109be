"""Stiff and extreme cases of the inverse side: from samples to light fields, polarization, turns and a calibration.

Each has a bounded answer or a confidence of 0. Run with NumPy's warnings as errors, as models/stability.py.
"""

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from talbot.models.calibrate import Sweep, block_means, calibrated
from talbot.models.capture import CaptureOperator
from talbot.models.parameters import (
    ArrayParameters,
    ElectricalParameters,
    OpticsParameters,
    ParameterError,
    SensorParameters,
    TileParameters,
)
from talbot.models.pixel import demodulate
from talbot.models.pixel.polarization import transmission
from talbot.models.pixel.time_of_flight import phase_of, tap_depths, tap_functions
from talbot.models.pixel.weights import density
from talbot.models.reconstruct import polarization
from talbot.models.reconstruct.bad_pixels import dead_pixels, repaired
from talbot.models.reconstruct.bayes import Estimate, FieldEstimator, FieldPrior
from talbot.models.reconstruct.coded import coded_depth
from talbot.models.reconstruct.depth_field import DepthField, depth_field, foreground, refocused, unwrap
from talbot.models.scene.echo import Echo
from talbot.models.stability import Case

Floats = npt.NDArray[np.floating]
PRIOR = FieldPrior(disparities=11)
SHAPE = 24, 30
SURE = 0.5  # px per view step: a larger standard deviation is no disparity
BOUND = 2.0  # times the brightest light of the scene, of every ray


def inverse_cases() -> list[Case]:
    """Run all cases of the inverse side."""
    return [case for group in GROUPS.values() for case in group()]


def _scene(slope: float = 1.0) -> Floats:
    """Return a light field of texture at a disparity of ``slope`` px per view step, 0.1..0.9, (5, 5, rows, cols)."""
    y, x = np.indices(SHAPE)
    steps = np.arange(-2, 3) * slope
    return np.array(
        [[0.5 + 0.2 * (np.sin(0.9 * (x + u)) + np.sin(0.7 * (y + v) + 0.4 * (x + u))) for u in steps] for v in steps]
    )


def _sensor(m: float = 0.7) -> SensorParameters:
    return SensorParameters(array=ArrayParameters(*SHAPE), optics=OpticsParameters(m=m))


def _fields() -> list[Case]:
    """Light fields from samples that are nothing, too much, wrong, or do not tell an angle."""
    sensor, truth, draw = _sensor(), _scene(), np.random.default_rng(5)
    estimator = FieldEstimator(sensor, 5, PRIOR)
    pair = CaptureOperator(sensor).forward(truth)
    dead = pair.copy()
    dead[:, :, 7::10] = 0
    copy = pair.copy()
    copy[:, 3, 4] = 0
    wrong = np.abs((estimate := _amid_dead(estimator, copy)).disparity - 1)[estimate.spread < SURE]
    dimmed = CaptureOperator(flat := _sensor(0.0)).forward(truth)
    out = [
        _bounded("black", estimator.mixture(0 * pair), 0.0, known=0.0),
        _bounded("full", estimator.mixture(np.ones_like(pair)), 1.0, known=0.0),
        _bounded("a third of it full", estimator.mixture(np.minimum(pair, 0.55)), 1.0),
        _bounded("dead columns", _amid_dead(estimator, dead), 1.0, known=0.0),
        _bounded("a dead pixel", _amid_dead(estimator, copy), 1.0),
        _bounded("noise of 40 %", estimator.mixture(pair * (1 + 0.4 * draw.standard_normal(pair.shape))), 1.6),
        _bounded("m = 0", FieldEstimator(flat, 5, PRIOR).mixture(dimmed), 1.0, known=0.0),
    ]
    out.append(_at_most("disparity amid a dead pixel: greatest error where sure", float(wrong.max(initial=0)), 0.3))
    some = np.arange(sensor.tile.n_types) != 9
    whole, part = (
        float(np.sqrt(np.mean((e.mixture(pair).light_field - truth) ** 2)))
        for e in (estimator, FieldEstimator(sensor, 5, PRIOR, measured=some))
    )
    name, bound = "light field without one pixel type", "at most 1.25 times the error of all types"
    out.append(Case(name, bound, f"{part:.4f}, {whole:.4f}", bool(part <= 1.25 * whole)))
    for shape in ((1, 1), (1, 7)):
        small = FieldEstimator(replace(sensor, array=ArrayParameters(*shape)), 5, PRIOR)
        name = f"of {shape[0]} x {shape[1]} pixels"
        out.append(_bounded(name, small.mixture(np.full((2, *shape), 0.5)), 0.5))
    worst = max(estimator.condition(d) for d in (None, *map(float, PRIOR.grid)))
    ends = 1 + 4 * estimator.covariances.height * estimator.covariances.width / PRIOR.noise**2
    out.append(_at_most("condition of a window's covariance", worst, ends))
    return out


def _amid_dead(estimator: FieldEstimator, pair: Floats) -> Estimate:
    """Return the estimate with dead pixels detected and repaired, without disparity next to them."""
    dead = dead_pixels(pair)
    estimate = estimator.mixture(repaired(pair, dead))
    return estimate._replace(spread=np.where(estimator.told_by(dead), np.inf, estimate.spread))


def _bounded(name: str, estimate: Estimate, top: float, known: float | None = None) -> Case:
    """Return an estimate within BOUND times the light ``top``; known: share of the pixels that may have a disparity."""
    field, sure = estimate.light_field, float((estimate.spread < SURE).mean())
    finite = bool(
        np.isfinite(field).all() and np.isfinite(estimate.disparity).all() and not np.isnan(estimate.spread).any()
    )
    peak = float(np.abs(field).max())
    ok = finite and peak <= BOUND * top + 1e-6 and (known is None or sure <= known)
    bound = f"|light| <= {BOUND * top:g}" + ("" if known is None else f", disparity of {100 * known:g} %")
    return Case(f"light field: {name}", bound, f"{peak:.3g}, {100 * sure:.0f} %", ok)


def _at_most(name: str, value: float, limit: float) -> Case:
    return Case(name, f"<= {limit:.3g}", f"{value:.3g}", bool(0 <= value <= limit))


def _polarizations() -> list[Case]:
    """Polarization from noise, dead columns, few pixels and gratings that hardly polarize."""
    tile, draw, d = TileParameters(), np.random.default_rng(6), 1 / 3
    gamma = np.array([t.gamma for t in tile.types])[tile.type_map(*SHAPE)]
    psi, plain = 0.6, np.full(SHAPE, 0.5)
    stokes = 0.5 * np.stack([np.full(SHAPE, np.cos(2 * psi)), np.full(SHAPE, np.sin(2 * psi))])
    seen = 0.5 * transmission(stokes, gamma, d)
    polarized = polarization(plain * (1 + 0.4 * draw.standard_normal(SHAPE)), tile, d, 0.003)
    wrong = float((polarized.confidence > 0).mean())
    out = [_at_most("unpolarized light with noise of 40 %: share that has a confidence", wrong, 0.01)]
    polarized = polarization(seen * (1 + 0.4 * draw.standard_normal(SHAPE)), tile, d, 0.003)
    out.append(_at_most("polarized light with noise of 40 %: greatest degree", float(polarized.degree.max()), 1.0))
    polarized = polarization(np.where(np.arange(SHAPE[1]) % 10 == 7, 0, seen), tile, d, 0.003)
    turned = np.rad2deg(np.abs((polarized.psi - psi + np.pi / 2) % np.pi - np.pi / 2))[polarized.confidence > 0.5]
    out.append(_at_most("dead columns in polarized light: error of psi in degrees where sure", float(turned.max()), 2))
    kept = tile.type_map(*SHAPE) != 9
    polarized = polarization(seen, tile, d, 0.003, kept)
    error = float(np.hypot(polarized.s1 - stokes[0], polarized.s2 - stokes[1]).max())
    out.append(_at_most("polarized light without one pixel type: error of the Stokes parameters", error, 1e-3))
    for shape in ((1, 1), (1, 7)):
        polarized = polarization(np.full(shape, 0.5), tile, d, 0.003)
        values = polarized.confidence + 0 * (polarized.light + polarized.psi + polarized.degree)
        out.append(_at_most(f"polarization of {shape[0]} x {shape[1]} pixels: confidence", float(values.max()), 0))
    polarized = polarization(0.5 * transmission(stokes, gamma, 1e-3), tile, 1e-3, 0.003)
    out.append(_at_most("gratings that hardly polarize: confidence", float(polarized.confidence.max()), 0))
    return out


def _depths() -> list[Case]:
    """Time of flight without light, of one pixel, and of edges that no phase shows."""
    estimator = FieldEstimator(_sensor(), 5, PRIOR)
    dark = depth_field(estimator, np.zeros((4, 2, *SHAPE)))
    phase, strength = demodulate(dark.centre)
    measured = float(np.abs(dark.taps).max() + np.abs(strength).max() + np.abs(refocused(dark.phasors, 0.7)).max())
    out = [_at_most("depth field of zero albedo: phasors", measured + 0 * float(np.abs(phase).max()), 1e-6)]
    none = foreground(DepthField(np.zeros((4, 3, 3, 1, 1)), np.zeros((1, 1)), np.ones((1, 1))), np.zeros((1, 1)))
    out.append(Case("occluder of one dark pixel", "none", "none" if none is None else "one", none is None))
    for turns in (0.0, 2.37):
        unwrapped = unwrap(np.full((1, 1), 2 * np.pi * (turns % 1)), np.full((1, 1), turns + 0.1), np.full((1, 1), 0.1))
        out.append(_at_most(f"turns of one pixel, {turns:g}", float(np.abs(unwrapped.turns - turns).max()), 1e-6))
    true = np.where(np.arange(SHAPE[1]) < 12, 0.7, 1.7) * np.ones(SHAPE)
    coarse = true + np.random.default_rng(7).normal(0, 0.2, SHAPE)
    unwrapped = unwrap(2 * np.pi * (true % 1), coarse, np.full(SHAPE, 0.2))
    wrong = float(((np.abs(unwrapped.turns - true) > 0.5) & unwrapped.sure).mean())
    out.append(_at_most("edge of exactly a turn: share wrong and sure", wrong, 0.02))
    unwrapped = unwrap(np.random.default_rng(8).uniform(0, 6, SHAPE), coarse, np.full(SHAPE, np.inf))
    out.append(_at_most("phase of noise, no disparity: share sure", float(unwrapped.sure.mean()), 0))
    out += _coded()
    far = unwrap(np.full(SHAPE, 1.0), np.full(SHAPE, 1e4), np.full(SHAPE, 1e3))
    out.append(_at_most("disparity at infinity: turns", float(np.abs(far.turns).max()), 2e4))
    return out


def _coded() -> list[Case]:
    """Coded light from nothing, from outside its gate, under noise, in one pixel, and from a scatterer alone."""
    electrical, draw = ElectricalParameters(code=31, code_delay=1.4e-8), np.random.default_rng(10)
    ends, taps = tap_depths(electrical), tap_functions(electrical)

    def _sure(name: str, light: Floats, limit: float = 0.0) -> Case:
        measured = coded_depth(light, electrical, 1.0)
        within = (
            np.isfinite(measured.amplitude) & (measured.depth >= ends[0] - 1e-9) & (measured.depth <= ends[-1] + 1e-9)
        )
        return _at_most(f"coded light {name}: share sure", float(measured.sure.mean()) + float(not within.all()), limit)

    def _from(depth: float) -> Floats:
        return np.stack([np.full(SHAPE, 100 * tap(depth)) for tap in taps])

    out = [_sure("without light", np.zeros((4, *SHAPE))), _sure("of no code, full", np.full((4, *SHAPE), 255.0))]
    out += [_sure(f"from {where} of its gate", _from(z)) for where, z in (("before", 0.9), ("behind", ends[-1] + 1))]
    out.append(_sure("that is noise", 100 + draw.normal(0, 1, (4, *SHAPE)), 0.02))
    measured = coded_depth(_from(3.0)[:, :1, :1] + 0.01, electrical, 1.0)
    out.append(_at_most("coded light of one pixel: error in m", float(np.abs(measured.depth - 3.0).max()), 1e-3))
    beyond = Echo(np.zeros((1, 1, *SHAPE)), np.ones((1, 1, 3)), 0.9, 0.1).returned(lambda z: phase_of(z, 1e8))
    mean = beyond(np.full(SHAPE, 5.0), np.full(SHAPE, 1e4), 0.0, 0.0) / phase_of(1.0, 1e8)
    out.append(_at_most("echoes alone, at a disparity of 10,000 px: error of their mean in m", np.ptp(mean), 1e-9))
    return out


def _calibrations() -> list[Case]:
    """Return a calibration without modulation, without a type, and without light."""
    tile, side = TileParameters(), np.linspace(-0.38, 0.38, 9)
    holes = np.stack([grid.ravel() for grid in np.meshgrid(side, side, indexing="ij")], 1)
    places = np.stack(np.meshgrid(*(np.arange(12.0) - 5.5 for _ in range(2)), indexing="ij"), -1)
    kinds, out = tile.type_map(12, 12), []

    def _swept(m: float) -> Sweep:
        light = 100 * density(tile.types, OpticsParameters(m=m), holes[:, 1], holes[:, 0])
        frames = np.moveaxis(light[kinds], -1, 0) + np.random.default_rng(9).normal(0, 0.3, (len(holes), 12, 12, 2))
        means = np.stack([block_means(frame, tile) for frame in frames])
        return Sweep(holes, means, block_means(places, tile), np.ones(tile.n_types))

    for m in (0.0, 1e-4, 1.0):
        calibration, pupil, fits = calibrated(_swept(m), 1e-5)
        error = max(abs((kind.m or 0) - m) for kind in calibration.types)
        out.append(_at_most(f"calibration of m = {m:g}: error of m", error, 0.01))
    out.append(_at_most("condition of a calibration", max(pupil.condition, *(fit.condition for fit in fits)), 100))
    dark = _swept(0.7)
    try:
        calibrated(replace(dark, diodes=0 * dark.diodes), 1e-5)
        said = "accepted"
    except ParameterError as error:
        said = str(error)
    out.append(Case("calibration without light", "an error that names the field", said, said.startswith("diodes = ")))
    return out


# By what they are of: functions that run their cases
GROUPS = {"light fields": _fields, "polarization": _polarizations, "depths": _depths, "calibrations": _calibrations}
