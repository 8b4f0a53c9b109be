"""The files of one run: stream, decoded samples, pictures and the report."""

from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
from markupsafe import Markup

from talbot.base.drawn import drawn
from talbot.base.kept import kept
from talbot.base.page import Picture, Scale, encoded
from talbot.imaging.frame import error_plots, pictures
from talbot.imaging.frame.chip_picture import chip_svg
from talbot.imaging.frame.figures import depth_line
from talbot.imaging.frame.merit import against, decibels, light_field
from talbot.imaging.frame.quality import Values, decoding_error, depth_error, depth_map, image_error, part_read
from talbot.imaging.frame.report import Views, render
from talbot.imaging.frame.result import FrameResult, GoldenResult, in_codes
from talbot.imaging.simulate.frame import WAVES
from talbot.models.parameters import (
    LIGHTS,
    SIGNED,
    STANDARD,
    CircuitEnergy,
    EnergyParameters,
    LightParameters,
    sensor_text,
    sources,
)
from talbot.models.parameters.drawn import drawn_sources
from talbot.models.parameters.sources import Sourced

# Every name that some mode writes: those that this run does not write are of an earlier run and are removed
PICTURES = ("overview", "scene", "differences", "image", "conversions", "depth", "edges", "views", "views_decoded")
PICTURES += ("differences_error", "image_error", "depth_error", "phase")
NAMES = (
    *("stream.bin", "decoded.npz", "sensor.toml", "report.html", "summary.json"),
    *(f"waves.{name}" for name in WAVES),
    *(f"{name}.png" for name in PICTURES),
)


MEASURED = "wall_s", "arguments", "tools", "rtl_cycles_per_s"  # of the summary: no picture shows them


class Drawn(NamedTuple):
    """The pictures of a frame, encoded. files: PNG by name, without suffix. The others: as of `report.render`."""

    files: dict[str, bytes]
    pictures: list[Picture]
    sheets: list[Picture]
    views: list[Views]


def write(folder: Path, result: FrameResult, summary: dict[str, Any]) -> None:
    """Write everything but summary.json into ``folder``, which exists."""
    (folder / "stream.bin").write_bytes(result.chip.stream)
    result.decoded.save(folder / "decoded.npz")
    (folder / "sensor.toml").write_text(sensor_text(result.request.sensor), encoding="utf-8")
    told = {name: value for name, value in summary.items() if name not in MEASURED}
    drawn = kept("pictures", _drawn, result.by_content, told)
    for name, data in drawn.files.items():
        (folder / f"{name}.png").write_bytes(data)
    chip = chip_svg(result.request.sensor, result.request.frame)
    curves = error_plots.figures(result, summary)
    where, assumed = _where(summary), assumptions(result)
    page = render(summary, drawn.pictures, chip, drawn.sheets, drawn.views, where, curves, assumed)
    (folder / "report.html").write_text(page, encoding="utf-8")


def _drawn(result: GoldenResult, summary: dict[str, Any]) -> Drawn:
    """Return the pictures of a frame. summary: without MEASURED."""
    singles, errors, sheets = shown(result, summary), error_maps(result, summary), _sheets(result)
    files = {picture.name: picture.png for picture in (*singles, *errors, *sheets)}
    files["overview"] = encoded(pictures.overview([(picture.name, picture.image) for picture in singles]))
    fields = _fields(result, summary)
    for name, field in zip(("views", "views_decoded"), fields, strict=False):
        files[name] = encoded(pictures.view_sheet(field[1]))
    every = [picture for single in singles for picture in (single, *(e for e in errors if e.title == single.name))]
    views = _views(fields)
    for view in views:
        _ = view.src  # encoded here, and kept with it
    return Drawn(files, every, sheets, views)


def shown(result: GoldenResult, summary: dict[str, Any]) -> list[Picture]:
    """Return the single pictures of the mode."""
    frame, golden, decoded, scene = result.request.frame, result.golden, result.decoded, result.exposed.scene
    out = [_gray("scene", "the scene, centre view", scene.image, 0.0, pictures.brightest(scene.image))]
    samples = in_codes(decoded.samples, frame).astype(float)
    converted = "which pixels were converted (yellow), unread (light)"
    if frame.mode in SIGNED:
        scale, rebuilt = max(float(np.abs(samples).max()), 1.0), result.rebuilt
        caption = "decoded differences, pixel by pixel (blue negative, red positive)"
        out.append(_signed("differences", caption, samples[..., 0], scale, "codes"))
        ends = (float(end) for end in np.quantile(rebuilt.image, (0.005, 0.995)))
        caption = f"2-D image rebuilt from edges ({rebuilt.method}): {against(summary)}"
        out.append(_gray("image", caption, *_within(result, rebuilt.image, *ends)))
        converted = "which samples were converted (yellow), zero by the window (dark), unread (light)"
    elif frame.mode == "tof":
        strength = result.echo[1]
        caption = f"2-D image, amplitude of the modulated light: {against(summary)}"
        out.append(_gray("image", caption, *_within(result, strength, 0.0, pictures.brightest(strength)), "codes"))
        out.append(_depth(result, summary))
    else:
        caption = f"2-D image, the sum of each pair: {against(summary)}"
        out.append(_gray("image", caption, *_within(result, result.image, 0.0, pictures.brightest(result.image))))
    if frame.mode == "ternary":  # which converts nothing
        return out
    decisions = pictures.decisions(golden.read, np.any(golden.converted, axis=2))
    return [*out, Picture("conversions", "", converted, decisions)]


def error_maps(result: GoldenResult, summary: dict[str, Any]) -> list[Picture]:
    """Errors of the single pictures; title: the name of the picture that it is of."""
    frame, decoded, golden = result.request.frame, result.decoded, result.golden
    out = []
    if frame.mode in SIGNED:
        error = np.full(golden.read.shape, np.nan)
        error[result.counted] = decoding_error(decoded.samples, result.exposed.ideal, result.counted, frame)[:, 0]
        caption = "error of the decoded differences: less those without noise, window and rounding; "
        caption += f"SNR {decibels(summary['snr_db'])}"
        out.append(_error("differences", caption, error, "codes"))
    if frame.mode != "tof":
        caption = "error of the 2-D image, brought to the mean of the scene, of white = 1"
        out.append(_error("image", caption, image_error(result), ""))
    errors = depth_error(result)
    if errors is not None and not np.isnan(errors).all():
        rms = summary["depth_rms_m"]
        out.append(_error("depth", f"error of the depth: {100 * rms:.3g} cm RMS", errors, "m"))
    return out


def _gray(name: str, caption: str, values: npt.ArrayLike, low: float, high: float, unit: str = "") -> Picture:
    image = pictures.gray(np.asarray(values, float), low, high)
    return Picture(name, "", caption, image, pictures.gray_scale(low, high, unit))


def _signed(name: str, caption: str, values: Values, scale: float, unit: str) -> Picture:
    return Picture(name, "", caption, pictures.signed(values, scale), pictures.signed_scale(scale, unit))


def _error(name: str, caption: str, error: Values, unit: str) -> Picture:
    """Return a signed map; its colours end where all but a hundredth of the pixels are within."""
    scale = max(float(np.nanquantile(np.abs(error), 0.99)), 1e-6)
    return replace(_signed(f"{name}_error", caption, np.nan_to_num(error), scale, unit), title=name)


def _depth(result: GoldenResult, summary: dict[str, Any]) -> Picture:
    """Return the depth from near to far, as far as the scene reaches where its depth is known."""
    depth, truth = depth_map(result), result.exposed.scene.depth
    seen = depth[~np.isnan(depth)] if truth is None else truth
    low, high = (float(np.quantile(seen, share)) for share in (0.0, 1.0)) if seen.size else (0.0, 1.0)
    margin = 0.05 * max(high - low, 0.1)
    low, high = max(low - margin, 0.0), high + margin
    scale = Scale(pictures.depth_colours(), low, high, "m")
    caption = f"depth from the phase (gray: no amplitude); {depth_line(summary) or 'the scene has no depth to compare'}"
    return Picture("depth", "", caption, pictures.depth(depth, low, high), scale)


def _within(result: GoldenResult, image: Values, low: float, high: float) -> tuple[Values, float, float]:
    """Return the image, white outside the rectangle that is read."""
    out, part = np.full_like(image, high), part_read(result.golden.read)
    out[part] = image[part]
    return out, low, high


def _sheets(result: GoldenResult) -> list[Picture]:
    """Return the contact sheets of the mode."""
    sensor, frame = result.request.sensor, result.request.frame
    if frame.mode not in (*SIGNED, "raw"):
        return []
    edges = result.edges
    caption = "one a pixel type, every sample of the tile grid: beta and gamma of the grating, "
    caption += "cosine or sine analyzer; blue negative, red positive"
    sheet = pictures.edge_sheet(edges, sensor.tile, max(float(np.abs(edges).max()), 1.0))
    return [Picture("edges", f"The {len(edges)} edge images", caption, sheet)]


def _fields(result: GoldenResult, summary: dict[str, Any]) -> list[tuple[str, Values]]:
    """Captions and light fields l[v, u, y, x] to show, relative radiance: the scene's, and in raw mode its estimate."""
    scene, out = result.exposed.scene, []
    if scene.angular or result.request.frame.mode == "raw":
        out.append(("the scene's light field: what the pixels saw", np.asarray(scene.full_light_field, float)))
    if result.request.frame.mode == "raw":
        field = np.maximum(result.estimate.light_field, 0)
        caption = f"estimate from the decoded diodes, {result.light_field_method}: {light_field(summary)}"
        out.append((caption, field))
    return out


def _views(fields: list[tuple[str, Values]]) -> list[Views]:
    """Return the fields for the slider, and the error of the second."""
    if not fields:
        return []
    top = pictures.brightest(fields[0][1])
    scaled = pictures.gray_scale(0.0, top, "")
    out = [Views.of(caption, pictures.grays(field, top), scaled) for caption, field in fields]
    if len(fields) > 1:
        error = fields[1][1] - fields[0][1]
        scale = max(float(np.quantile(np.abs(error), 0.99)), 1e-6)
        views = [[pictures.signed(view, scale) for view in row] for row in error]
        scaled = pictures.signed_scale(scale, "")
        out.append(Views.of("error: the estimate less the scene's", views, scaled))
    return out


def _where(s: dict[str, Any]) -> list[Markup]:
    """Charts of cycles, energy and bytes, as SVG."""
    pins = s["cycles_by_pin"]
    phases = ("pixel_reset", "integrate", "cm_reset", "read", "waiting")
    cycles = {name.replace("_", " "): pins[name] for name in phases}
    energy = energy_parts(s)
    return [
        drawn("bars", cycles, "cycles", f"Cycles: the amplifiers' phases ({s['cycles']:,} in all)"),
        drawn("bars", energy, "µJ", f"Energy, the lower reading ({s['energy_uj']['total']:.1f} µJ)"),
        drawn("bars", circuit_parts(s), "µJ", f"Energy by the circuits ({s['energy_uj']['circuits']:.1f} µJ)"),
        drawn("bars", s["bytes"], "bytes", f"Bytes ({s['stream_bytes']:,})"),
    ]


def energy_parts(s: dict[str, Any]) -> dict[str, float]:
    """Parts of ``total`` of the summary ``s`` in uJ: of the digital part's two sources the smaller."""
    energy = s["energy_uj"]
    parts = {name.replace("_", " "): energy[name] for name in ("pixel_array", "amplifiers", "adcs", "pads")}
    name, source = min(("timing", "Table 6.1"), ("digital", "layout"), key=lambda pair: energy[pair[0]])
    return parts | {f"digital part ({source})": energy[name]}


def circuit_parts(s: dict[str, Any]) -> dict[str, float]:
    """Parts of ``circuits`` of the summary ``s`` in uJ."""
    energy = s["energy_uj"]
    parts = {name.removeprefix("circuits_"): value for name, value in energy.items() if name.startswith("circuits_")}
    return parts | {"digital part (layout)": energy["digital"], "pads": energy["pads"]}


def assumptions(result: FrameResult) -> list[Sourced]:
    """Every parameter of the camera, of noise, light and energy, named with its part, and where it comes from."""
    sensor = result.request.sensor
    columns = result.request.columns
    source = "ngspice: models/parameters/circuit.json"
    optics, electrical = sensor.optics, sensor.electrical
    parts = {"camera": optics.camera, "optics": optics, "array": sensor.array, "electrical": electrical}
    parts |= {
        "room": result.request.room,
        "energy": EnergyParameters(),
        "circuits": CircuitEnergy(),
        "light source": LightParameters(),
    }
    lamp, of_lamp = result.request.room.spectrum, ("efficacy", "wavelength", "quantum_efficiency")
    if lamp is not None:
        parts["spectral"] = sensor.spectral
    drawn = drawn_sources(electrical)
    rows = [row._replace(name=f"{part} {row.name}") for part, group in parts.items() for row in sources(group)]
    rows = [row._replace(source=drawn.get(row.name.removeprefix("electrical "), row.source)) for row in rows]
    if lamp is not None:  # these follow from the spectrum
        rows = [row for row in rows if row.name not in [f"room {name}" for name in of_lamp]]
        rows.append(Sourced("room spectrum", lamp.name, "", "[CIE15]" if lamp.name in LIGHTS else "set"))
    circuit = sensor.converter == STANDARD.converter
    rows += [
        row._replace(name=f"converter {row.name}", source=source if circuit else row.source)
        for row in sources(sensor.converter)
    ]
    for name, value in vars(columns).items() if columns else ():
        text = ", ".join(f"{number:.6g}" for number in (value if isinstance(value, tuple) else (value,)))
        rows.append(Sourced(f"columns {name}", text, "", source))
    return rows
