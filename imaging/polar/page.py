"""The files of a frame's polarization: page, arrays."""

from pathlib import Path
from typing import Any

import numpy as np

from talbot.base.page import TABLES, Picture, Scale, Section, Tile, render
from talbot.imaging.frame import pictures
from talbot.imaging.frame.reading import agreement, line, number
from talbot.imaging.polar.measure import PolarFrame, Values
from talbot.models.pixel.polarization import angle

NAMES = ("polar.html", "summary.json", "polar.npz")
METHOD = "each pixel's fit of light, gradient and polarization"


def write(folder: Path, frame: PolarFrame) -> None:
    """Write everything but summary.json into ``folder``, which exists."""
    polarized, s = frame.found, frame.summary
    np.savez(
        folder / "polar.npz",
        psi=polarized.psi.astype(np.float32),
        degree=polarized.degree.astype(np.float32),
        confidence=polarized.confidence.astype(np.float32),
        light=polarized.light.astype(np.float32),
        highlights=frame.tags,
        full=frame.full,
    )
    angles = _angles(frame)
    text = render(
        TABLES,
        f"{s['scene']}: the polarization of a raw frame",
        picture=angles[1].image,
        about=line(s),
        tiles=_headline(s),
        sections=[
            Section("Every method, with baselines", head=HEAD, rows=_rows(s)),
            Section("Angle", "Gray: no polarization seen. The scale is cyclic.", pictures=angles),
            Section("Degree", pictures=_degrees(frame)),
            Section("Highlights", _tagged(s), pictures=_highlights(frame)),
            *_depths(frame),
        ],
    )
    (folder / "polar.html").write_text(text, encoding="utf-8")


HEAD = ("", "psi, mean error", "psi, float samples", "degree, RMS error", "highlights, F1")


def _rows(s: dict[str, Any]) -> list[tuple[str, ...]]:
    free = s["baselines"]
    return [
        ("one angle, no polarization, brightest pixels", _deg(free["psi_error_constant_deg"]), "")
        + (number(free["degree_rms_none"], 3), number(free["f1_bright"], 3)),
        ("four orientations demosaiced", _deg(s["psi_error_demosaiced_deg"]), "")
        + (number(s["degree_rms_demosaiced"], 3), ""),
        (METHOD, _deg(s["psi_error_deg"]), _deg(s["psi_error_float_deg"]))
        + (number(s["degree_rms"], 3), number(s["f1"], 3)),
    ]


def _deg(value: float | None) -> str:
    return number(value, 2, "°")


def _headline(s: dict[str, Any]) -> list[Tile]:
    free, tagged = s["baselines"], "bad" if s["full_tagged"] else "good" if s["full"] else ""
    return [
        Tile("none", "polarization seen")
        if s["psi_error_deg"] is None
        else Tile(
            _deg(s["psi_error_deg"]), f"psi, mean error (one angle for all: {_deg(free['psi_error_constant_deg'])})"
        ),
        Tile("none", "highlights in the scene")
        if s["f1"] is None
        else Tile(number(s["f1"], 3), f"F1 of the highlights (brightest pixels: {number(free['f1_bright'], 3)})"),
        Tile(str(s["full_tagged"]), f"of {s['full']:,} full pixels tagged", tagged),
        agreement(s),
        Tile(f"{s['seconds']:.1f} s", "for the polarization"),
    ]


def _tagged(s: dict[str, Any]) -> str:
    return f"Yellow: polarized light above {s['highlight']:g} of white. Full pixels have none that can be seen."


def _angles(frame: PolarFrame) -> list[Picture]:
    sure = frame.found.confidence > 0
    psi, degree = frame.truth
    scale = Scale(pictures.angle_colours(), -90, 90, "degrees")
    return [
        Picture("true", "", "angle of the scene", pictures.angle(np.where(degree > 0, psi, np.nan)), scale),
        Picture("psi", "", "angle by the fit", pictures.angle(np.where(sure, frame.found.psi, np.nan)), scale),
        Picture("demosaiced", "", "angle by demosaicing, everywhere: edges look polarized", _plain_angle(frame), scale),
    ]


def _plain_angle(frame: PolarFrame) -> pictures.Image:
    return pictures.angle(angle(*frame.plain))


def _degrees(frame: PolarFrame) -> list[Picture]:
    named: list[tuple[str, str, Values]] = [
        ("true-degree", "degree of the scene", frame.truth[1]),
        ("degree", "degree by the fit, where it is sure", frame.found.degree * (frame.found.confidence > 0)),
        ("confidence", "confidence: 0 where no polarization is seen", frame.found.confidence),
    ]
    scale = Scale(pictures.depth_colours(), 0, 1)
    return [Picture(name, "", caption, pictures.depth(values, 0, 1), scale) for name, caption, values in named]


def _depths(frame: PolarFrame) -> list[Section]:
    """Return pictures of the disparity with and without the highlights, and of the truth."""
    off, truth = frame.summary["disparity"], frame.result.exposed.scene.disparity
    if frame.disparity is None or truth is None:
        return []
    low, high = float(truth.min()), float(truth.max())
    scale = Scale(pictures.depth_colours(), low, high, "px per view step")
    named = [("disparity-true", "of the scene", truth)]
    for key, caption, values in zip(
        ("found", "untagged"), ("as found", "without the highlights"), frame.disparity, strict=True
    ):
        named.append((f"disparity-{key}", f"{caption}: {number(off[f'{key}_rms_px'], 2)} px RMS in them", values))
    shown = [Picture(name, "", what, pictures.depth(values, low, high), scale) for name, what, values in named]
    text = (
        "A mirror image is at another depth than the surface that shows it: what is tagged takes the disparity around "
        f"it. Of as many of the brightest pixels: {number(off['unbright_rms_px'], 2)} px RMS; one disparity for all: "
        f"{number(off['constant_rms_px'], 2)} px."
    )
    return [Section("Disparity without the highlights", text, pictures=shown)]


def _highlights(frame: PolarFrame) -> list[Picture]:
    light = pictures.gray(frame.result.image)
    out = [Picture("image", "", "the sum image", light)]
    shine = frame.result.exposed.scene.specular
    for name, caption, mask in (
        ("shine", "highlights of the scene", shine),
        ("tags", "highlights tagged", frame.tags),
        ("full", "full pixels", frame.full),
    ):
        if mask is not None:
            out.append(Picture(name, "", caption, pictures.marked(frame.result.image, mask)))
    return out
