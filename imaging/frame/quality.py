"""Quality of a frame: each figure with a baseline that costs nothing and the usual alternative.

Defined in docs/figures.md. None where a figure has no meaning: no such samples, no error at all, too few pixels.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt
from PIL import __version__ as VERSION

from talbot.base.kept import kept
from talbot.imaging.frame.codecs import CODECS, absent, coded
from talbot.imaging.frame.result import GoldenResult, in_codes
from talbot.models.capture import cells
from talbot.models.chip import golden_frame
from talbot.models.parameters import SIGNED, FrameParameters
from talbot.models.pixel import depth_of
from talbot.models.reconstruct import psnr_db, psnr_without_mean_db, sum_image

Codes, Values = npt.NDArray[np.integer], npt.NDArray[np.float64]
TURN = 256  # codes of a phase
SSIM_WINDOW = 7  # px
ROUNDING = 1e-6  # codes RMS: a signal of less is what arithmetic leaves of none


def ideal_samples(ideal: Values, frame: FrameParameters) -> Values:
    """Return the codes that a perfect chip would send, (rows, cols, subs).

    The analog values, or, of the four taps, their phase (256 = a turn) and amplitude.
    """
    if not frame.phase:
        return ideal
    x, y = ideal[..., 0] - ideal[..., 2], ideal[..., 3] - ideal[..., 1]
    phase = np.mod(np.arctan2(y, x) * (TURN / (2 * np.pi)), TURN)
    return np.stack([phase, np.maximum(np.abs(x), np.abs(y))], -1)


def decoding_error(samples: Codes, ideal: Values, read: npt.NDArray[np.bool_], frame: FrameParameters) -> Values:
    """Decoded less ideal for every sample read, in codes, (n, subs).

    The error of a phase is the short way round, and 0 where the chip marks it as not valid (amplitude 0).
    """
    error = in_codes(samples[read], frame) - ideal_samples(ideal, frame)[read]
    if frame.phase:
        error[:, 0] = np.mod(error[:, 0] + TURN / 2, TURN) - TURN / 2
        error[samples[read][:, 1] == 0] = 0
    return error


def snr(error: Values, signal: Values) -> float | None:
    """10 log10 of the signal's energy over the error's, in dB; None without a signal or an error. Both in codes."""
    noise, power = float(np.sum(np.square(error))), float(np.sum(np.square(signal)))
    return 10 * float(np.log10(power / noise)) if noise and power > signal.size * ROUNDING**2 else None


def sent_quality(result: GoldenResult) -> dict[str, float | None]:
    """Return figures of the decoded samples against the noiseless ones: snr_db, snr_nothing_sent_db, edges, phases."""
    frame, read, samples = result.request.frame, result.counted, result.decoded.samples
    ideal = ideal_samples(result.exposed.ideal, frame)[read]
    error = decoding_error(samples, result.exposed.ideal, read, frame)
    phases: dict[str, float | None] = {}
    if frame.phase:
        valid = samples[read][:, 1] > 0
        turns = float(np.sqrt(np.mean(error[valid, 0] ** 2))) / TURN if valid.any() else None
        phases = {"phase_rms_turns": turns, "phase_valid": float(valid.mean()) if valid.size else None}
        ideal, error = ideal[:, 1:], error[:, 1:]
    # Edges are about zero; of other samples a receiver could know the mean without any byte.
    nothing = np.zeros(1) if frame.mode in SIGNED else ideal.mean(0) if ideal.size else np.zeros(1)
    signal = ideal - nothing
    figures = {"snr_db": snr(error, signal), "snr_nothing_sent_db": snr(nothing - ideal, signal)}
    return {**figures, **_edges(samples[read], result.exposed.ideal[read], frame), **phases}


def _edges(sent: Codes, ideal: Values, frame: FrameParameters) -> dict[str, float | None]:
    names = ("edge_precision", "edge_recall", "edge_share", "edge_energy_kept")
    if frame.mode not in SIGNED:
        return dict.fromkeys(names)
    detected, true = sent != 0, np.abs(np.rint(ideal)) >= max(frame.threshold, 1)
    both, energy = int((detected & true).sum()), float(np.sum(ideal**2))
    parts = (
        (both, int(detected.sum())),
        (both, int(true.sum())),
        (int(true.sum()), true.size),
        (float(np.sum(ideal[detected] ** 2)), energy),
    )
    return {name: part / whole if whole else None for name, (part, whole) in zip(names, parts, strict=True)}


def image_quality(result: GoldenResult) -> dict[str, float | str | None]:
    """Return PSNR and SSIM of the 2-D image against the scene's centre view, of flat gray, of codecs at as many bytes.

    image_jpegxl_absent: why JPEG XL has no figure here; None where it has.
    """
    codecs = [name for name in CODECS if not absent(name)]
    figures = kept("images", image_figures, result.by_content, len(result.stream), codecs, VERSION)
    none = {f"image_{figure}": None for name in CODECS for figure in (f"psnr_{name}_db", f"ssim_{name}")}
    return {"image_jpegxl_absent": absent("jpegxl")} | none | figures


def image_figures(result: GoldenResult, size: int, codecs: Sequence[str], version: str) -> dict[str, float | None]:
    """PSNR and SSIM of the image, of flat gray, of the coded sum, and of it in ``size`` bytes of each codec.

    version: of Pillow, which has most codecs.
    """
    part = part_read(result.golden.read)
    truth, seen = np.asarray(result.exposed.scene.image, float)[part], coded_sum(result)[part]
    clear = ~result.exposed.full[part]
    images = {"": result.image[part], "_gray": np.zeros_like(truth), "_sum": seen}
    images |= {f"_{name}": coded(seen, name, size) for name in codecs}
    out: dict[str, float | None] = {}
    for name, shown in images.items():
        shown = shown if clear.any() else None
        out[f"image_psnr{name}_db"] = None if shown is None else psnr_without_mean_db(shown[clear], truth[clear])
        out[f"image_ssim{name}"] = None if shown is None else ssim(shown, truth, clear)
    return out


def part_read(read: npt.NDArray[np.bool_]) -> tuple[slice, slice]:
    """Return the smallest rectangle of all pixels that are read; nothing outside is compared."""
    rows, cols = (np.flatnonzero(read.any(axis)) for axis in (1, 0))
    return slice(rows[0], rows[-1] + 1), slice(cols[0], cols[-1] + 1)


def ssim(image: Values, truth: Values, clear: npt.NDArray[np.bool_] | None = None) -> float | None:
    """Structural similarity after the image has the mean of the truth, peak 1; clear: where, None is everywhere."""
    if min(truth.shape) < SSIM_WINDOW:
        return None
    from skimage.metrics import structural_similarity  # it imports much of SciPy

    clear = np.ones(truth.shape, bool) if clear is None else clear
    level = image - image[clear].mean() + truth[clear].mean()
    found: Any = structural_similarity(level, truth, data_range=1.0, win_size=SSIM_WINDOW, full=True)
    inner = (slice(SSIM_WINDOW // 2, -(SSIM_WINDOW // 2)),) * 2  # whole windows
    return float(found[1][inner][clear[inner]].mean()) if clear[inner].any() else None


def coded_sum(result: GoldenResult) -> Values:
    """Return the sum image that the same exposure gives in image mode, every pixel read, relative radiance."""
    request, samples = result.request, result.exposed.samples
    frame = FrameParameters(request.sensor.full_window, mode="image", timing=request.frame.exposing)
    sums = golden_frame(samples.mean(0, keepdims=True), request.sensor, frame, result.exposed.front_end)
    # A tap of time of flight is half of the light on average.
    half = 2.0 if request.frame.mode == "tof" else 1.0
    read = result.golden.read
    return np.asarray(
        sum_image(half * sums.codes[..., 0].astype(float), request.lit, read, request.frame.exposing), float
    )


def clear_psnr_db(
    estimate: npt.NDArray[np.floating], truth: npt.NDArray[np.floating], clear: npt.NDArray[np.bool_]
) -> float | None:
    """PSNR of the pixels ``clear`` (rows, cols) of all views; None of none."""
    return psnr_db(estimate[..., clear], truth[..., clear]) if clear.any() else None


def field_quality(result: GoldenResult) -> dict[str, float | str | None]:
    """Return method and PSNR of the light field in raw mode against the scene's, and of the copied sum image."""
    if result.request.frame.mode != "raw":
        return {"light_field_method": None, "light_field_psnr_db": None, "light_field_psnr_copied_db": None}
    # Corners that the round pupil does not reach have no light
    part = (cells(result.exposed.scene.views), *part_read(result.golden.read))
    truth = np.asarray(result.exposed.scene.full_light_field, float)[part]
    field = result.estimate.light_field[part]
    copied = np.broadcast_to(result.image[part[1:]], truth.shape)
    clear = ~result.exposed.full[part[1:]]
    out: dict[str, float | str | None] = {"light_field_method": result.light_field_method}
    out |= {
        "light_field_psnr_db": clear_psnr_db(field, truth, clear),
        "light_field_psnr_copied_db": clear_psnr_db(copied, truth, clear),
    }
    if result.request.calibration:
        true = replace(result, request=replace(result.request, calibration=None))
        out["light_field_psnr_true_optics_db"] = clear_psnr_db(true.estimate.light_field[part], truth, clear)
    return out


def depth_quality(result: GoldenResult) -> dict[str, float | None]:
    """Return the RMS error of the depth in time of flight in m, where the amplitude is not 0; of one depth for all."""
    truth, error = result.exposed.scene.depth, depth_error(result)
    if truth is None or error is None or np.isnan(error).all():
        return {"depth_rms_m": None, "depth_rms_constant_m": None}
    seen = ~np.isnan(error)
    return {
        "depth_rms_m": float(np.sqrt(np.mean(error[seen] ** 2))),
        "depth_rms_constant_m": float((truth[seen] - truth[seen][0]).std()),
    }


def depth_map(result: GoldenResult) -> Values:
    """Return the depth in time of flight, (rows, cols) in m, NaN where there is no amplitude or a well is full."""
    phase, strength = result.echo
    depth = depth_of(phase, result.request.sensor.electrical.f_mod)
    return np.where(result.counted & (strength > 0), depth, np.nan)


def depth_error(result: GoldenResult) -> Values | None:
    """`depth_map` less the scene's depth, the short way round; None in other modes and without a scene's depth."""
    truth = result.exposed.scene.depth
    if result.request.frame.mode != "tof" or truth is None:
        return None
    far = float(depth_of(np.pi, result.request.sensor.electrical.f_mod))  # half of the unambiguous range
    return np.mod(depth_map(result) - truth + far, 2 * far) - far


def image_error(result: GoldenResult) -> Values:
    """The 2-D image, brought to the mean of the scene's centre view, less this view.

    NaN where nothing is read and where a well is full.
    """
    part = part_read(result.golden.read)
    truth, error = np.asarray(result.exposed.scene.image, float)[part], np.full(result.image.shape, np.nan)
    error[part] = result.image[part] - result.image[part].mean() + truth.mean() - truth
    return np.where(result.exposed.full, np.nan, error)


def quality(result: GoldenResult) -> dict[str, Any]:
    """All figures of this file."""
    return sent_quality(result) | image_quality(result) | field_quality(result) | depth_quality(result)
