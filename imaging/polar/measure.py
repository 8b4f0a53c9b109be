"""Polarization and highlights from a raw frame, with their errors and those of baselines."""

from collections.abc import Callable
from dataclasses import dataclass
from time import perf_counter
from typing import Any

import numpy as np
import numpy.typing as npt

from talbot.imaging.frame.light_field import estimate, full
from talbot.imaging.frame.reading import about, rms
from talbot.imaging.frame.result import GoldenResult
from talbot.models.pixel.polarization import angle
from talbot.models.reconstruct import (
    Polarization,
    demosaiced,
    polarization,
    specular_tags,
    sum_image,
    sum_noise,
    without_highlights,
)

Values = npt.NDArray[np.floating]
Bools = npt.NDArray[np.bool_]
QUIET = 0.3  # of the noise at noise 1: what rounding leaves without any other
POLARIZED = 0.02  # degree below which the truth has no angle


@dataclass(frozen=True, eq=False)
class PolarFrame:
    """Polarization from a raw frame. tags: highlights. plain: by demosaicing alone, (s1, s2).

    disparity: in px per view step, as found and without the highlights; of a frame of a scene with highlights.
    """

    result: GoldenResult
    found: Polarization
    plain: tuple[Values, Values]
    full: Bools
    tags: Bools
    summary: dict[str, Any]
    disparity: tuple[Values, Values] | None = None

    @property
    def truth(self) -> tuple[Values, Values]:
        """Angle in rad and degree of the scene, (rows, cols)."""
        s1, s2 = self.result.exposed.scene.seen_polarization
        return angle(s1, s2), np.hypot(s1, s2)


def read_polarization(
    result: GoldenResult, highlight: float, note: Callable[[str], None] = lambda text: None
) -> PolarFrame:
    """Return the polarization of a raw frame of any part of the array. highlight: of a highlight's polarized light."""
    note("polarization")
    start = perf_counter()
    polarized, sums, over = estimated(result, result.decoded.samples.astype(float))
    seconds = perf_counter() - start
    ideal, _, _ = estimated(result, result.exposed.ideal)
    plain = demosaiced(sums, result.sensor.tile, result.sensor.optics.diattenuation)
    tags = specular_tags(polarized, highlight)
    shine = result.exposed.scene.specular
    bright = None if shine is None else sums > np.quantile(sums, 1 - shine.mean())
    disparity, off = _disparity(result, tags, over, bright, note)
    frame = PolarFrame(result, polarized, plain, over, tags, {}, disparity)
    psi, degree = frame.truth
    sure = polarized.confidence > 0
    shown = sure & (degree > POLARIZED)
    constant = np.full(psi.shape, np.angle(np.exp(2j * psi[shown]).mean()) / 2) if shown.any() else psi
    frame.summary.update(
        about(result)
        | {
            "highlight": highlight,
            "sure": float(sure.mean()),
            "psi_error_deg": angle_error(polarized.psi, psi, shown),
            "psi_error_sure_deg": angle_error(polarized.psi, psi, shown & (polarized.confidence > 0.5)),
            "psi_error_float_deg": angle_error(ideal.psi, psi, shown),
            "psi_error_demosaiced_deg": angle_error(angle(*plain), psi, shown),
            "degree_rms": rms((polarized.degree - degree)[shown]),
            "degree_rms_float": rms((ideal.degree - degree)[shown]),
            "degree_rms_demosaiced": rms((np.hypot(*plain) - degree)[shown]),
            "wrongly_polarized": float((sure & (degree <= POLARIZED)).mean()),
            "full": int(over.sum()),
            "full_tagged": int((tags & over & ~(np.zeros_like(tags) if shine is None else shine)).sum()),
            "seconds": seconds,
            "f1": None if shine is None else _f1(tags, shine),
            "disparity": off,
            "baselines": {
                "psi_error_constant_deg": angle_error(constant, psi, shown),
                "degree_rms_none": rms((degree)[shown]),
                "f1_bright": None if bright is None or shine is None else _f1(bright, shine),
            },
        }
    )
    return frame


def _disparity(
    result: GoldenResult, tags: Bools, over: Bools, bright: Bools | None, note: Callable[[str], None]
) -> tuple[tuple[Values, Values] | None, dict[str, float | None] | None]:
    """Disparity by `make lightfield`'s estimator as it is and without the highlights, and its errors in px.

    RMS in the highlights of the scene: as found, without what is tagged, without as many of the brightest pixels, and
    one disparity for all. None where the scene tells no highlights or disparity, or a part of the array is read.
    """
    scene = result.exposed.scene
    if scene.specular is None or scene.disparity is None or not result.decoded.read.all() or not scene.specular.any():
        return None, None
    note("disparity")
    got = estimate(result, "mixture")
    assert got.disparity is not None and got.spread is not None and bright is not None
    # A full pixel tells no disparity, and is filled where it is tagged alone
    spread = np.where(over, np.inf, got.spread)
    free = without_highlights(got.disparity, spread, tags)[0]
    by_light = without_highlights(got.disparity, spread, bright)[0]
    errors = {"found": got.disparity, "untagged": free, "unbright": by_light}
    out = {f"{name}_rms_px": rms((values - scene.disparity)[scene.specular]) for name, values in errors.items()}
    out["constant_rms_px"] = float(np.std(scene.disparity[scene.specular]))
    return (got.disparity, free), out


def prepared(result: GoldenResult, pairs: Values) -> tuple[Values, Values, Bools, Bools]:
    """From diodes (rows, cols, 2) in LSB the sums, 1 = white, their noise, the pixels that count, and the full ones."""
    request = result.request
    lit, timing = request.lit, request.frame.exposing
    sums = np.asarray(sum_image(pairs.sum(2) / 2, lit, timing=timing), float)
    over = full(pairs, (2,))
    noise = max(request.noise, QUIET) * np.asarray(sum_noise(sums, lit, timing))
    return sums, noise, result.decoded.read & ~over, over


def estimated(result: GoldenResult, pairs: Values) -> tuple[Polarization, Values, Bools]:
    """Polarization from diodes (rows, cols, 2) in LSB, the sums that it is from (1 = white), and the full pixels."""
    sums, noise, used, over = prepared(result, pairs)
    optics = result.sensor.optics
    return polarization(sums, result.sensor.tile, optics.diattenuation, noise, used), sums, over


def angle_error(angles: Values, truth: Values, where: Bools) -> float | None:
    """Mean distance of two angles modulo pi, in degrees; None where there are none."""
    turned = np.abs((angles - truth + np.pi / 2) % np.pi - np.pi / 2)[where]
    return float(np.rad2deg(turned.mean())) if turned.size else None


def _f1(tagged: Bools, truth: Bools) -> float | None:
    """Harmonic mean of precision and recall; None where there is nothing to find and nothing found."""
    total = int(tagged.sum()) + int(truth.sum())
    return 2 * int((tagged & truth).sum()) / total if total else None
