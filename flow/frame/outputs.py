"""The files of one run: stream, decoded samples, pictures and the report."""

from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from talbot.base.charts import bars, svg
from talbot.models.parameters import EnergyParameters, LightParameters, sensor_text, sources

from . import error_plots, pictures
from .chip_picture import chip_svg
from .figures import depth_line
from .quality import Values, part_read
from .report import Picture, against, decibels, render
from .result import FrameResult, GoldenResult

# Every name that some mode writes: those that this run does not write are of an earlier run and are removed
PICTURES = ("overview", "scene", "differences", "image", "conversions", "phase", "edges", "views", "views_decoded")
NAMES = (
    *("stream.bin", "decoded.npz", "sensor.toml", "report.html", "summary.json", "waves.vcd"),
    *(f"{name}.png" for name in PICTURES),
)


def write(folder: Path, result: FrameResult, summary: dict[str, Any]) -> None:
    """Write everything but summary.json into ``folder``, which exists."""
    (folder / "stream.bin").write_bytes(result.chip.stream)
    result.decoded.save(folder / "decoded.npz")
    (folder / "sensor.toml").write_text(sensor_text(result.request.sensor))
    singles, sheets = shown(result, summary), _sheets(result, summary)
    for picture in (*singles, *sheets):
        picture.image.save(folder / f"{picture.name}.png")
    pictures.overview([(picture.name, picture.image) for picture in singles]).save(folder / "overview.png")
    large = [picture._replace(image=pictures.enlarge(picture.image, 384)) for picture in singles]
    chip = chip_svg(result.request.sensor, result.request.frame)
    errors = [svg(figure) for figure in error_plots.figures(result, summary)]
    (folder / "report.html").write_text(
        render(summary, large, chip, sheets, _where(summary), errors, assumptions(result))
    )


def shown(result: GoldenResult, summary: dict[str, Any]) -> list[Picture]:
    """The single pictures of the mode."""
    frame, golden, decoded, scene = result.request.frame, result.golden, result.decoded, result.exposed.scene
    out = [Picture("scene", "", "the scene, centre view", pictures.gray(scene.image, high=_top(scene.image)))]
    samples = decoded.samples.astype(float)
    converted = "which pixels were converted (yellow), unread (light)"
    if frame.mode == "edge":
        scale, rebuilt = max(float(np.abs(samples).max()), 1.0), result.rebuilt
        differences = pictures.signed(samples[..., 0], scale)
        image = pictures.gray(*_within(result, rebuilt.image, *np.quantile(rebuilt.image, (0.005, 0.995))))
        caption = "decoded differences, pixel by pixel (blue negative, red positive)"
        out.append(Picture("differences", "", caption, differences))
        out.append(Picture("image", "", f"2-D image rebuilt from edges ({rebuilt.method}): {against(summary)}", image))
        converted = "which samples were converted (yellow), zero by the window (dark), unread (light)"
    elif frame.mode == "tof":
        phase, strength = result.echo
        image = pictures.gray(*_within(result, strength, 0.0, _top(strength)))
        hue = pictures.phase_wheel(phase, strength / _top(strength))
        caption = f"time-of-flight phase as hue (one turn), amplitude as brightness; {depth_line(summary)}"
        out.append(Picture("image", "", f"2-D image, amplitude of the modulated light: {against(summary)}", image))
        out.append(Picture("phase", "", caption, hue))
    else:
        image = result.image
        out.append(
            Picture(
                "image",
                "",
                f"2-D image, the sum of each pair: {against(summary)}",
                pictures.gray(*_within(result, image, 0.0, _top(image))),
            )
        )
    decisions = pictures.decisions(golden.read, np.any(golden.converted, axis=2))
    return [*out, Picture("conversions", "", converted, decisions)]


def _within(result: GoldenResult, image: Values, low: float, high: float) -> tuple[Values, float, float]:
    """The image, white outside the rectangle of what is read: no sample of the frame is there."""
    out, part = np.full_like(image, high), part_read(result.golden.read)
    out[part] = image[part]
    return out, low, high


def _top(values: npt.NDArray[np.floating]) -> float:
    return max(float(np.quantile(values, 0.999)), 1e-6)


def _sheets(result: FrameResult, summary: dict[str, Any]) -> list[Picture]:
    """The contact sheets of the mode."""
    sensor, frame, scene = result.request.sensor, result.request.frame, result.exposed.scene
    out = []
    if frame.mode in ("edge", "raw"):
        edges = result.edges
        caption = "one a pixel type, every sample of the tile grid: beta and gamma of the grating, "
        caption += "cosine or sine analyzer; blue negative, red positive"
        sheet = pictures.edge_sheet(edges, sensor.tile, max(float(np.abs(edges).max()), 1.0))
        out.append(Picture("edges", "The 24 edge images", caption, sheet))
    if scene.angular:
        sheet = pictures.view_sheet(scene.full_light_field)
        out.append(Picture("views", "The scene's light field", "what the pixels saw, view by view", sheet))
    if frame.mode == "raw":
        sheet = pictures.view_sheet(np.maximum(result.light_field, 0))
        found, copied = (summary[f"light_field_psnr{name}_db"] for name in ("", "_copied"))
        caption = "linear estimate from the decoded diodes, view by view: PSNR "
        caption += f"{decibels(found)}; the 2-D image in every view has {decibels(copied)}"
        out.append(Picture("views_decoded", "The light field read back", caption, sheet))
    return out


def _where(s: dict[str, Any]) -> list[str]:
    """Charts of cycles, energy and bytes, as SVG."""
    pins = s["cycles_by_pin"]
    phases = ("pixel_reset", "integrate", "cm_reset", "read", "waiting")
    cycles = {name.replace("_", " "): pins[name] for name in phases}
    parts = ("pixel_array", "amplifiers", "timing", "adcs", "pads")
    energy = {name.replace("_", " "): s["energy_uj"][name] for name in parts}
    return [
        svg(bars(cycles, "cycles", f"Cycles: the amplifiers' phases ({s['cycles']:,} in all)")),
        svg(bars(energy, "uJ", f"Energy ({s['energy_uj']['total']:.1f} uJ)")),
        svg(bars(s["bytes"], "bytes", f"Bytes ({s['stream_bytes']:,})")),
    ]


def assumptions(result: FrameResult) -> list[tuple[str, object, str]]:
    """Every parameter of the camera, of noise and energy, its value in SI units and where it comes from."""
    sensor = result.request.sensor
    converter = [(f"converter {name}", value, "assumed") for name, value in vars(sensor.converter).items()]
    optics, array = sensor.optics, sensor.array
    known = (optics.camera, optics, array, sensor.electrical, EnergyParameters(), LightParameters())
    return [*(row for parameters in known for row in sources(parameters)), *converter]
