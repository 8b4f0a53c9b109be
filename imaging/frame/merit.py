"""The figures of merit of a summary, each with a baseline that costs nothing and the usual alternative."""

from collections.abc import Callable
from typing import Any

from talbot.models.parameters import SIGNED

IMAGES = {"_gray": "flat gray", "_sum": "sum image", "_jpeg": "JPEG", "_avif": "AVIF", "_jpegxl": "JPEG XL"}
Summary = dict[str, Any]


def decibels(value: float | None) -> str:
    """Return a figure in dB."""
    return "-" if value is None else f"{value:.1f} dB"


def percent(value: float | None) -> str:
    """Return a fraction in %."""
    return "-" if value is None else f"{100 * value:.3g} %"


def ratio(value: float | None) -> str:
    """Return a figure without a unit."""
    return "-" if value is None else f"{value:.2f}"


def against(s: Summary) -> str:
    """Return the PSNR of the 2-D image and that of flat gray, of JPEG and of JPEG XL."""
    image, gray, jpeg, jpegxl = (decibels(s[f"image_psnr{name}_db"]) for name in ("", "_gray", "_jpeg", "_jpegxl"))
    psnr, nothing = s["image_psnr_db"], s["image_psnr_gray_db"]  # None: no error at all
    note = ", no better than gray" if psnr is not None and (nothing is None or psnr <= nothing) else ""
    if s["image_jpegxl_absent"]:
        jpegxl = f"not compared ({s['image_jpegxl_absent']})"
    return f"PSNR {image}{note}; flat gray {gray}; as many bytes of JPEG {jpeg}, of JPEG XL {jpegxl}"


def sent(s: Summary) -> str:
    """Return the SNR of the decoded samples and that of nothing sent."""
    return f"SNR {decibels(s['snr_db'])} ({nothing_sent(s)})"


def nothing_sent(s: Summary) -> str:
    """Return the baseline of the SNR of the decoded samples."""
    snr, nothing = s["snr_db"], s["snr_nothing_sent_db"]  # None: no error at all, or no signal
    note = "no better than " if snr is not None and snr <= (nothing or 0.0) else ""
    return f"{note}nothing sent: {decibels(nothing)}"


def light_field(s: Summary) -> str:
    """PSNR of the light field's estimate next to that of the 2-D image in every view."""
    psnr, copied = s["light_field_psnr_db"], s["light_field_psnr_copied_db"]
    note = ", no better" if psnr is not None and (copied is None or psnr <= copied) else ""
    return f"PSNR {decibels(psnr)}{note}; the 2-D image in every view has {decibels(copied)}"


def table(s: Summary) -> list[tuple[str, str, str]]:
    """Return name, figure and baseline of each figure of the mode, in the report's order."""
    rows = [("SNR of the samples", decibels(s["snr_db"]), nothing_sent(s))]
    if s["mode"] in SIGNED:
        share = percent(s["edge_share"])
        rows += [
            ("edges among the samples sent (precision)", percent(s["edge_precision"]), f"of all samples: {share}"),
            ("edges that are sent (recall)", percent(s["edge_recall"]), "nothing sent: 0 %"),
            ("energy of the differences that is sent", percent(s["edge_energy_kept"]), "nothing sent: 0 %"),
        ]
    if "phase_rms_turns" in s:
        turns = "-" if s["phase_rms_turns"] is None else f"{s['phase_rms_turns']:.3g} turns"
        rows.append(("phase, RMS error", turns, f"valid: {percent(s['phase_valid'])} of the samples"))
    if s["quadrature_error_codes"] is not None:
        views = f"{s['camera']['views']} views along the pupil, against 31"
        rows.append(("quadrature of the capture, RMS error", f"{s['quadrature_error_codes']:.2f} codes", views))
    if s["hidden_light_codes"] is not None:
        baseline = "0 where the middle view and its disparity are the whole scene"
        rows.append(("light that the middle view does not see, RMS", f"{s['hidden_light_codes']:.2f} codes", baseline))
    for what, key, shown in (("PSNR", "image_psnr{}_db", decibels), ("SSIM", "image_ssim{}", ratio)):
        rows.append((f"2-D image, {what}", shown(s[key.format("")]), _images(s, key, shown)))
    if s["light_field_psnr_db"] is not None:
        baseline = f"2-D image in every view: {decibels(s['light_field_psnr_copied_db'])}"
        rows.append((f"light field by {s['light_field_method']}, PSNR", decibels(s["light_field_psnr_db"]), baseline))
    if s["depth_rms_m"] is not None:
        baseline = f"one depth for all: {100 * s['depth_rms_constant_m']:.3g} cm"
        rows.append(("depth, RMS error", f"{100 * s['depth_rms_m']:.3g} cm", baseline))
    return rows


def _images(s: Summary, key: str, shown: Callable[[float | None], str]) -> str:
    names = {end: name for end, name in IMAGES.items() if end != "_jpegxl" or not s["image_jpegxl_absent"]}
    return ", ".join(f"{name} {shown(s[key.format(end)])}" for end, name in names.items())
