"""Stiff and extreme cases of the optical models: what is expected of each, and what is measured.

Run with NumPy's warnings as errors (as verif/stability.py does): no case may warn or produce a NaN.
"""

import tempfile
from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from PIL import Image

from talbot.models.capture import CaptureOperator, Exposure, capture, expose
from talbot.models.capture.operator import rounding
from talbot.models.parameters import (
    AmpTiming,
    ArrayParameters,
    CameraParameters,
    ElectricalParameters,
    FrameParameters,
    OpticsParameters,
    ParameterError,
    PixelType,
    SensorParameters,
    TileParameters,
)
from talbot.models.pixel import Ripple, exact, gains, response
from talbot.models.pixel.polarization import transmission
from talbot.models.pixel.quadrature import sampled
from talbot.models.plan import plan
from talbot.models.reconstruct import EdgeOperator, image_from_edges, polarization
from talbot.models.reconstruct.depth_field import unwrap
from talbot.models.scene import Sampling, load


@dataclass(frozen=True)
class Case:
    """One case of the table.

    name, bound, measured: name, expectation and measurement, as text.
    ok: the measurement meets the expectation.
    """

    name: str
    bound: str
    measured: str
    ok: bool


def table(cases: Iterable[Case]) -> str:
    """Format cases as text, one per line.

    cases: rows of the table. Returns aligned columns with a header.
    """
    rows = [
        ("", "case", "expected", "measured"),  # the verdict first: a message is longer than a line
        *(("ok" if c.ok else "FAILED", c.name, c.bound, c.measured) for c in cases),
    ]
    widths = [max(len(str(r[i])) for r in rows) for i in range(4)]
    return "\n".join("  ".join(str(v).ljust(w) for v, w in zip(r, widths, strict=True)).rstrip() for r in rows)


def optical_cases() -> list[Case]:
    """Run all optical cases."""
    return [
        *_responses(),
        *_integrals(),
        _unseen_diode(),
        *_exposures(),
        *_frames(),
        _adjoint(),
        _one_view(),
        *_pictures(),
        _no_edges(),
        *_polarizations(),
        *_turns(),
    ]


def _within(name: str, bound: str, value: float, low: float, high: float) -> Case:
    """Return a case that is ok where low <= value <= high (never for NaN)."""
    return Case(name, bound, f"{value:.3g}", bool(low <= value <= high))


def _responses() -> list[Case]:
    """rho out to grazing light for every extreme of m and beta, in both precisions."""
    out = []
    for dtype in ("float32", "float64"):
        for m in (0.0, 1.0):
            for beta in (0.0, 50.0):
                for degrees in (45.0, 89.9, 90.0):
                    theta = np.deg2rad(np.array([-degrees, 0, degrees], dtype))
                    rho = np.stack(
                        [response(alpha, beta, 0.7, theta[:, None], theta[None, :], m, 0.2) for alpha in (0.0, np.pi)]
                    )
                    name = f"response, {dtype}, m = {m:g}, beta = {beta:g}, theta to {degrees:g} degrees"
                    ok = np.isfinite(rho).all() and rho.min() >= 0 and rho.max() <= 1 + m
                    out.append(Case(name, f"0..{1 + m:g}", f"{rho.min():.2g}..{rho.max():.4g}", bool(ok)))
    return out


def _integrals() -> list[Case]:
    """View weights against the adaptive quadrature at the extremes of the optics."""
    types = (PixelType(0, 0, 0.4), PixelType(50, 30, 0.4))
    still = Ripple(periods=0)
    out = []
    for name, optics, bound in (
        ("m = 0", OpticsParameters(m=0.0), 1e-6),
        ("m = 1", OpticsParameters(m=1.0), 1e-4),
        ("f/0.5", OpticsParameters(CameraParameters(f_number=0.5), subsamples=16), 1e-4),
        ("f/32", OpticsParameters(CameraParameters(f_number=32.0)), 1e-9),
        ("aperture 0.01 rad", OpticsParameters(aperture_sigma=0.01, subsamples=32), 1e-4),
        ("31 views", OpticsParameters(views=31, subsamples=4), 1e-6),
    ):
        reference = exact(types, optics, still)
        error = float(np.abs(sampled(types, optics, still) - reference).max() / reference.mean())
        out.append(
            _within(
                f"weights against adaptive quadrature, beta 0 and 50, {name}", f"error <= {bound:g}", error, 0, bound
            )
        )
    return out


def _unseen_diode() -> Case:
    """Check m = 1, beta = 0: the second diode receives nothing; its capacitor ratio would be infinite."""
    g = gains(np.array([-1.0, 1.0]))
    return Case(
        "trim of a pixel with one blind diode",
        "1/64 and 64",
        f"{g[0]:g} and {g[1]:g}",
        bool(np.allclose(g, [1 / 64, 64])),
    )


def _exposures() -> list[Case]:
    """Currents, noise and wells far beyond the working range."""
    pair = np.stack([np.full((8, 12), 0.5), np.full((8, 12), 0.4)])
    full = ElectricalParameters(read_noise=0, offset_fpn=0, column_fpn=0, flicker_noise=0)
    usual, many = ElectricalParameters(), 5 * 100.0  # sigmas of 100 times the noise
    still = np.sqrt(usual.read_noise**2 + usual.offset_fpn**2 + usual.column_fpn**2 + usual.flicker_noise**2)
    far = float(np.ceil(many * still / usual.lsb_electrons))
    cases = (
        ("saturated scene", pair * 40, full, AmpTiming(), 0.0, 127.5, 127.5),
        ("saturated scene, 255 common-mode resets", pair * 40, full, AmpTiming(n_cm=255), 0.0, 0, 127.5),
        ("black scene, no noise", pair * 0, full, AmpTiming(), 0.0, 0, 0.001),
        ("noise 100 times physical, dim scene", pair * 1e-3, usual, AmpTiming(), 100.0, -far, far),
        ("denormal currents", pair * 1e-310, full, AmpTiming(), 1.0, 0, 0.1),
        ("currents of 1e30", pair * 1e30, full, AmpTiming(), 100.0, 0, 127.5),
        (
            "a minute's exposure at 1 kHz",
            pair,
            replace(full, white_current=1e-3),
            AmpTiming(t_int=65535),
            1.0,
            127.5,
            127.5,
        ),
    )
    out = []
    for name, light, electrical, timing, noise, low, high in cases:
        f_clk = 1e3 if "1 kHz" in name else 10e6
        samples = expose(light, Exposure(electrical, timing, f_clk, noise))
        ok = np.isfinite(samples).all() and low - 1e-9 <= samples.min() and samples.max() <= high + 1e-9
        out.append(
            Case(
                f"exposure: {name}", f"{low:g}..{high:g} LSB", f"{samples.min():.4g}..{samples.max():.4g} LSB", bool(ok)
            )
        )
    return out


def _frames() -> list[Case]:
    """Whole captures of odd arrays, masks and scenes: every sample finite, unread pixels dark."""
    out = []
    for rows, cols, scene, mode, mask in (
        (4, 6, "motorcycle", "edge", 1 << 23),
        (1, 37, "camera", "edge", 0xFFFFFF),
        (37, 1, "camera", "raw", 0xFFFFFF),
        (4, 6, "saturated", "image", 0xFFFFFF),
        (9, 13, "black", "tof", 0xFFFFFF),
        (9, 13, "tilted", "tof", 1),
    ):
        sensor = SensorParameters(array=ArrayParameters(rows, cols))
        frame = FrameParameters(sensor.full_window, mode=mode, mask=mask)
        seen = load(scene, Sampling(rows, cols))
        planned = plan(seen, sensor, frame)
        samples = capture(seen, sensor, planned, Exposure(sensor.electrical, frame.timing, noise=0.0))
        dark = samples[:, ~planned.read].max(initial=0.0)
        limit = 127.5 * (1 + 1e-12)
        ok = np.isfinite(samples).all() and samples.min() >= 0 and samples.max() <= limit and dark < 0.001
        out.append(
            Case(
                f"capture of {scene}, {rows} x {cols}, {mode}, mask {mask:06x}",
                "0..127.5 LSB, unread < 0.001",
                f"{samples.min():.3g}..{samples.max():.4g}, unread {dark:.2g}",
                bool(ok),
            )
        )
    return out


def _adjoint() -> Case:
    """<Phi x, y> = <x, Phi' y> at the largest number of views."""
    sensor = SensorParameters(array=ArrayParameters(7, 11), optics=OpticsParameters(views=31, subsamples=2))
    operator, draw = CaptureOperator(sensor), np.random.default_rng(0)
    x, y = draw.standard_normal(operator.shape), draw.standard_normal((2, 7, 11))
    left, right = np.vdot(operator.forward(x), y), np.vdot(x, operator.transpose(y))
    scale = np.vdot(operator.forward(np.abs(x)), np.abs(y))
    return _within(
        "capture operator and its transpose, 31 x 31 views",
        "relative difference <= 1e-12",
        float(abs(left - right) / scale),
        0,
        1e-12,
    )


def _one_view() -> Case:
    """Compare one view with 25 equal ones, in single precision."""
    sensor = SensorParameters(array=ArrayParameters(12, 18))
    image = np.random.default_rng(0).random((12, 18), np.float32)
    few = CaptureOperator(sensor, "float32", angular=False).forward(image[None, None])
    all_ = CaptureOperator(sensor, "float32").forward(np.broadcast_to(image, (5, 5, 12, 18)))
    bound = rounding("float32", 5)
    return _within(
        "one view for 25 equal ones, float32",
        f"relative difference <= {bound:.2g}",
        float((np.abs(few - all_) / all_).max()),
        0,
        bound,
    )


def _pictures() -> list[Case]:
    """Picture files of every kind."""
    gray = np.tile(np.linspace(0, 255, 64).astype(np.uint8), (48, 1))
    good = {
        "16-bit": gray.astype(np.uint16) * 257,
        "colour": np.stack([gray, gray[::-1], gray], -1),
        "colour and alpha": np.stack([gray] * 4, -1),
        "1 x 1": gray[:1, 40:41],
        "1 x 64": gray[:1],
        "huge, 12000 x 9000": np.tile(gray, (250, 140)),
    }
    bad = {"NaN": np.nan, "infinity": np.inf, "negative": -1.0}
    out = []
    with tempfile.TemporaryDirectory() as folder:
        for name, codes in good.items():
            path = Path(folder) / "picture.png"
            Image.fromarray(codes).save(path, compress_level=1)
            image = load(str(path), Sampling(16, 24)).image
            ok = np.isfinite(image).all() and image.min() >= 0 and image.max() <= 1
            out.append(Case(f"picture: {name}", "radiance 0..1", f"{image.min():.3g}..{image.max():.3g}", bool(ok)))
        for name, value in bad.items():
            pixels = np.full((8, 12), 0.5, np.float32)
            pixels[3, 4] = value
            path = Path(folder) / "picture.tif"
            Image.fromarray(pixels).save(path)
            out.append(_refused(f"picture: {name} in a pixel", str(path)))
        (Path(folder) / "text.png").write_text("no picture", encoding="utf-8")
        out.append(_refused("picture: not an image", str(Path(folder) / "text.png")))
        out.append(_refused("picture: no such file", str(Path(folder) / "none.png")))
    return out


def _refused(name: str, path: str) -> Case:
    try:
        load(path, Sampling(16, 24))
        measured = "accepted"
    except ParameterError as error:
        measured = str(error).replace(path, Path(path).name)
    return Case(name, "an error that names the field", measured, measured.startswith("scene = "))


def _no_edges() -> Case:
    """A scene in focus has no edges, so that the equations for its image are all zero."""
    tile = TileParameters()
    operator = EdgeOperator(SensorParameters(array=ArrayParameters(8, 12)), np.zeros((8, 12)), np.ones(tile.n_types))
    image = image_from_edges(np.zeros((8, 12)), operator)
    return _within("image from no edges at all", "0", float(np.abs(image).max()), 0, 0)


def _polarizations() -> list[Case]:
    """Check the angle of polarization near its wrap, in darkness, full pixels, without an orientation."""
    tile, shape = TileParameters(), (16, 18)
    gamma = np.array([t.gamma for t in tile.types])[tile.type_map(*shape)]
    out = []
    for degrees in (89.999, -89.999):
        psi = np.deg2rad(degrees)
        stokes = 0.25 * np.stack([np.full(shape, np.cos(2 * psi)), np.full(shape, np.sin(2 * psi))])
        polarized = polarization(0.5 * transmission(stokes, gamma, 1 / 3), tile, 1 / 3, 0.003)
        error = float(np.rad2deg(np.abs((polarized.psi - psi + np.pi / 2) % np.pi - np.pi / 2)).max())
        out.append(_within(f"psi of {degrees:g} degrees", "error <= 0.001 degrees", error, 0, 1e-3))
    some, all_ = np.abs(np.rad2deg(gamma)) < 1, np.ones(shape, bool)
    for name, level, used in (("black", 0.0, all_), ("full", 1.25, ~all_), ("of 0 degrees alone", 0.5, some)):
        polarized = polarization(np.full(shape, level), tile, 1 / 3, 0.003, used)
        values = polarized.confidence + 0 * (polarized.light + polarized.psi + polarized.degree)
        out.append(_within(f"polarization of pixels that are {name}", "confidence 0", float(values.max()), 0, 0))
    return out


def _turns() -> list[Case]:
    """Phase near 2 pi, none at all, and a depth that nothing tells."""
    shape, out = (12, 18), []
    for turns in (1 - 1e-9, 1.0, 3 + 1e-9):
        unwrapped = unwrap(np.full(shape, 2 * np.pi * (turns % 1)), np.full(shape, turns), np.full(shape, 0.2))
        error = float(np.abs(unwrapped.turns - turns).max())
        out.append(_within(f"turns of a phase, {turns:.9f}", "error <= 1e-6 turns", error, 0, 1e-6))
    none, zero, unknown = np.full(shape, np.nan), np.zeros(shape), np.full(shape, np.inf)
    for name, phase, doubt in (("no phase (zero albedo, full)", none, zero), ("depth beyond all tried", zero, unknown)):
        unwrapped = unwrap(phase, zero, doubt)
        measured = float(unwrapped.sure.mean() + np.abs(unwrapped.turns).max())
        out.append(_within(f"turns where there is {name}", "0, not sure", measured, 0, 0))
    return out
