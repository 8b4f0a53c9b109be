"""The files of one run: stream, decoded samples, pictures and the report."""

import numpy as np

from base.charts import bars, svg
from models.capture import CaptureOperator
from models.reconstruct import edge_images, light_field_estimate, sum_image

from . import errors, pictures
from .chip_picture import chip_svg
from .report import render

# Every name that some mode writes: what this run did not write is an earlier run's and goes
NAMES = (
    "stream.bin",
    "decoded.npz",
    "report.html",
    "summary.json",
    "waves.vcd",
    "overview.png",
    "scene.png",
    "differences.png",
    "image.png",
    "conversions.png",
    "phase.png",
    "edges.png",
    "views.png",
    "views_decoded.png",
)
PHASE_TURN = 2 * np.pi / 256  # rad a code


def write(folder, result, summary):
    """Write everything but summary.json into ``folder`` (a Path that exists)."""
    (folder / "stream.bin").write_bytes(result.chip.stream)
    result.decoded.save(folder / "decoded.npz")
    named, sheets = _pictures(result), _sheets(result)
    for name, _, image in named:
        image.save(folder / f"{name}.png")
    for name, _, _, image in sheets:
        image.save(folder / f"{name}.png")
    pictures.overview(named).save(folder / "overview.png")
    page = render(
        summary,
        pictures=[(caption, pictures.enlarge(image, 384)) for _, caption, image in named],
        chip=chip_svg(result.request.sensor, result.request.frame),
        sheets=[(title, caption, image) for _, title, caption, image in sheets],
        where=_where(summary),
        errors=[svg(figure) for figure in errors.figures(result, summary)],
    )
    (folder / "report.html").write_text(page)


def _pictures(result):
    """Single pictures: list of (file name, caption, image)."""
    frame, golden, decoded = result.request.frame, result.golden, result.decoded
    high = max(float(np.quantile(result.exposed.scene.image, 0.999)), 1e-6)
    out = [("scene", "the scene, centre view", pictures.gray(result.exposed.scene.image, high=high))]
    samples = decoded.samples.astype(float)
    if frame.mode == "edge":
        scale = max(float(np.abs(samples).max()), 1.0)
        out.append(
            (
                "differences",
                "decoded differences, pixel by pixel (blue negative, red positive)",
                pictures.signed(samples[..., 0], scale),
            )
        )
        rebuilt = result.rebuilt
        out.append(
            (
                "image",
                f"2-D image rebuilt from the edges alone ({rebuilt.method})",
                pictures.gray(rebuilt.image, *np.quantile(rebuilt.image, (0.005, 0.995))),
            )
        )
        out.append(
            (
                "conversions",
                "which samples were converted (yellow), zero by the window (dark), unread (light)",
                pictures.decisions(golden.read, golden.converted.any(2)),
            )
        )
        return out
    if frame.mode == "tof":
        phase, strength = _phase(samples, frame)
        out.append(
            ("image", "2-D image: amplitude of the modulated light", pictures.gray(strength, high=_top(strength)))
        )
        out.append(
            (
                "phase",
                "time-of-flight phase as hue (one turn), amplitude as brightness",
                pictures.phase_wheel(phase, strength / _top(strength)),
            )
        )
    else:
        total = samples[..., 0] if frame.mode == "image" else samples.sum(2) / 2
        image = sum_image(total, result.request.sensor, decoded.read)
        out.append(("image", "2-D image: the sum of each pair", pictures.gray(image, high=_top(image))))
    out.append(
        (
            "conversions",
            "which pixels were converted (yellow), unread (light)",
            pictures.decisions(golden.read, golden.converted.any(2)),
        )
    )
    return out


def _top(values):
    return max(float(np.quantile(values, 0.999)), 1e-6)


def _phase(samples, frame):
    """Phase (rad) and amplitude of a time-of-flight frame: two arrays (rows, cols)."""
    if frame.phase:
        return samples[..., 0] * PHASE_TURN, samples[..., 1]
    x, y = samples[..., 0] - samples[..., 2], samples[..., 3] - samples[..., 1]
    return np.arctan2(y, x), np.hypot(x, y)


def _sheets(result):
    """Contact sheets: list of (file name, title, caption, image)."""
    sensor, frame, decoded = result.request.sensor, result.request.frame, result.decoded
    out = []
    if frame.mode in ("edge", "raw"):
        samples = decoded.samples.astype(float)
        difference = samples[..., 0] if frame.mode == "edge" else samples[..., 0] - samples[..., 1]
        edges = edge_images(difference, sensor.tile)
        out.append(
            (
                "edges",
                "The 24 edge images",
                "one a pixel type, every sample of the tile grid: beta and gamma of the "
                "grating, cosine or sine analyzer; blue negative, red positive",
                pictures.edge_sheet(edges, sensor.tile, max(float(np.abs(edges).max()), 1.0)),
            )
        )
    if result.exposed.scene.angular:
        out.append(
            (
                "views",
                "The scene's light field",
                "what the pixels saw, view by view",
                pictures.view_sheet(result.exposed.scene.full_light_field),
            )
        )
    if frame.mode == "raw":
        operator = CaptureOperator(sensor, read=decoded.read)
        pair = np.moveaxis(decoded.samples.astype(float), 2, 0)
        out.append(
            (
                "views_decoded",
                "The light field read back",
                "linear estimate from the decoded diodes, view by view",
                pictures.view_sheet(np.maximum(light_field_estimate(operator, pair), 0)),
            )
        )
    return out


def _where(s):
    pins = s["cycles_by_pin"]
    cycles = {
        name.replace("_", " "): pins[name] for name in ("pixel_reset", "integrate", "cm_reset", "read", "waiting")
    }
    energy = {name.replace("_", " "): value for name, value in s["energy_uj"].items() if name != "total"}
    return [
        svg(bars(cycles, "cycles", f"Cycles: the amplifiers' phases ({s['cycles']:,} in all)")),
        svg(bars(energy, "uJ", f"Energy ({s['energy_uj']['total']:.1f} uJ)")),
        svg(bars(s["bytes"], "bytes", f"Bytes ({s['stream_bytes']:,})")),
    ]
