"""The files of a depth field: page, arrays."""

from pathlib import Path
from typing import Any

import numpy as np

from talbot.base.page import TABLES, Picture, Scale, Section, Tile, render
from talbot.imaging.depth.measure import SINE, Depth, Values
from talbot.imaging.frame import pictures
from talbot.imaging.frame.reading import agreement, line, number
from talbot.models.reconstruct.depth_field import refocused

NAMES = ("depth.html", "summary.json", "depth.npz")
HEAD = ("", "RMS where sure", "of the range", "sure", "RMS everywhere")
TEXTS = {
    "constant": "one depth for all",
    "light_field": "disparity alone",
    "wrapped": "phase alone, modulo a turn",
    "divider": "sums, the chip's divider",
    "sums": "sums, float quadrature",
    "field_divider": "depth field, the chip's divider (bit-true model)",
    "field": "depth field, float quadrature",
    "field_float": "depth field, samples without noise and converter",
    "three": "depth field of three taps: nothing moves",
    "code": "coded light, sums",
    "code_field": "coded light, depth field",
}


def write(folder: Path, depth: Depth) -> None:
    """Write everything but summary.json into ``folder``, which exists."""
    s = depth.summary
    best, sure = depth.depth[depth.lead], depth.sure[depth.lead]
    arrays = {"taps": depth.field.taps.astype(np.float16), "disparity": depth.field.disparity, "confidence": sure}
    arrays |= {"depth": best.astype(np.float32)}
    if depth.behind is not None:
        arrays["behind"] = depth.behind.astype(np.float32)
    np.savez(folder / "depth.npz", allow_pickle=False, **arrays)
    shown = _depths(depth)
    groups = [
        Section("Every method, with baselines", head=HEAD, rows=rows(s)),
        Section("Depth", "Gray: the number of turns is not known, or there is no phase.", pictures=shown),
        Section(
            "Refocused", "Phase through the whole lens: sharp at one depth, mixed at others.", pictures=_focus(depth)
        ),
    ]
    if depth.behind is not None:
        groups.append(Section("Past the occluder", _past(s), pictures=_behind(depth)))
    text = render(
        TABLES,
        f"{s['scene']}: depth by time of flight",
        picture=shown[1].image,
        about=f"{line(s)}; {s['range_m']:.3g} m of range, {s['ambiguity_m']:.3g} m a turn of the phase",
        tiles=_headline(s),
        sections=groups,
    )
    (folder / "depth.html").write_text(text, encoding="utf-8")


def rows(s: dict[str, Any]) -> list[tuple[str, ...]]:
    """Rows of the table of the summary ``s``: baselines, then methods."""
    return [(TEXTS[name], *_row(m, s["range_m"])) for name, m in (s["baselines"] | s["methods"]).items()]


def _row(m: dict[str, Any], span: float) -> tuple[str, ...]:
    share = "-" if m["rms_m"] is None or not span else f"{100 * m['rms_m'] / span:.2f} %"
    whole = f" ({100 * m['rms_all_m'] / span:.2f} %)" if span else ""
    return number(m["rms_m"], 4, " m"), share, f"{100 * m['sure']:.1f} %", number(m["rms_all_m"], 4, " m") + whole


def lead_line(s: dict[str, Any]) -> str:
    """Return the leading method of the summary ``s``, its error where it is reliable, and the baseline."""
    lead = s["depth_method"]
    error, _, sure, _ = _row(s["methods"][lead], s["range_m"])
    baseline = f"one depth for all {number(s['baselines']['constant']['rms_m'], 4, ' m')}"
    if lead != SINE:
        baseline += f", without the code {number(s['methods'][SINE]['rms_m'], 4, ' m')}"
    return f"{TEXTS[lead]}: {error} RMS in {sure} of the pixels ({baseline})"


def _headline(s: dict[str, Any]) -> list[Tile]:
    lead = s["depth_method"]
    free, methods = s["baselines"], s["methods"]
    error, share, sure, whole = _row(methods[lead], s["range_m"])
    other = "divider" if lead == SINE else SINE
    return [
        Tile("none", "of the pixels has a depth that is sure")
        if methods[lead]["rms_m"] is None
        else Tile(
            error, f"{TEXTS[lead]}: {share} of the range (one depth for all: {number(free['constant']['rms_m'])} m)"
        ),
        Tile(sure, f"of the pixels are sure; over all {whole}"),
        *(
            [
                Tile(
                    number(methods[other]["rms_m"], 4, " m"),
                    TEXTS[other] + ("" if lead == SINE else ", without the code"),
                )
            ]
            if other in methods
            else []
        ),
        agreement(s),
    ]


def _past(s: dict[str, Any]) -> str:
    past = s["behind"]
    return (
        f"{100 * past['occluded']:.0f} % of the picture is the occluder's. Behind it {past['rms_m']:.3g} m RMS of "
        f"{past['range_m']:.3g} m, where rays pass it ({100 * past['seen']:.0f} %); by all rays, the occluder's among "
        f"them, {past['rms_all_rays_m']:.3g} m; one depth for all {past['rms_constant_m']:.3g} m."
    )


def _ends(values: Values) -> tuple[float, float]:
    return float(values.min()), float(values.max()) + 1e-3


def _picture(name: str, caption: str, values: Values, ends: tuple[float, float]) -> Picture:
    scale = Scale(pictures.depth_colours(), *ends, "m")
    return Picture(name, "", caption, pictures.depth(values, *ends), scale)


def _depths(depth: Depth) -> list[Picture]:
    truth = depth.truth
    ends = _ends(truth)
    wrapped = depth.depth[SINE] % depth.summary["ambiguity_m"]

    def known(method: str, name: str) -> Picture:
        return _picture(name, TEXTS[method], np.where(depth.sure[method], depth.depth[method], np.nan), ends)

    return [
        _picture("true", "depth of the scene", truth, ends),
        known(depth.lead, "depth"),
        *([known(SINE, "sine")] if depth.lead != SINE else []),
        _picture("wrapped", f"{TEXTS[SINE]}, modulo a turn", wrapped, (0, depth.summary["ambiguity_m"])),
        _picture("coarse", "depth by disparity alone", depth.coarse, ends),
        *([known("divider", "divider")] if "divider" in depth.depth else []),
    ]


def _focus(depth: Depth) -> list[Picture]:
    scale = Scale(pictures.angle_colours(), 0, 360, "degrees")
    out = []
    for name, disparity in zip(
        ("far", "middle", "near"), np.quantile(depth.field.disparity, (0.05, 0.5, 0.95)), strict=True
    ):
        phase = np.angle(refocused(depth.field.phasors, float(disparity)))
        caption = f"phase, focused {name}: at {disparity:+.2f} px a view step"
        out.append(Picture(name, "", caption, pictures.angle(phase / 2 % np.pi - np.pi / 2), scale))
    return out


def _behind(depth: Depth) -> list[Picture]:
    truth = np.asarray(depth.frames.sums.exposed.scene.behind)
    ends = _ends(truth)
    return [
        _picture("true-behind", "depth behind the occluder, of the scene", truth, ends),
        _picture("behind", "found with the rays that pass it", np.asarray(depth.behind), ends),
    ]
