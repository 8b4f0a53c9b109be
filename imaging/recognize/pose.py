"""Head pose [Jayasuriya2017, Sec. A.4]: yaw and pitch of a rendered head from one binary gradient, or an image."""

from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt
from threadpoolctl import threadpool_limits

from talbot.imaging.recognize import chip, study
from talbot.imaging.recognize.data import Pictures
from talbot.imaging.recognize.intensity import ACTIVE
from talbot.imaging.recognize.study import Setting, Work, in_focus
from talbot.models.recognition import gradient, kernel
from talbot.models.recognition.statistics import Spread

HEADS, SIZE = 2000, 32  # pictures, and their px
YAW, PITCH = 45.0, 30.0  # deg, largest angles
VIEW = 1.35  # half of the picture, in half heights of a head
SHOWN = 12  # pictures on the page
Floats = npt.NDArray[np.float64]


def heads(count: int, seed: int) -> tuple[npt.NDArray[np.float32], Floats]:
    """Pictures (count, SIZE, SIZE) of heads in linear radiance, and their yaw and pitch in deg (count, 2).

    An ellipsoid with nose, eyes, mouth and hair before a background with a gradient; proportions, reflectances, place,
    and the direction of the light differ from head to head.
    """
    rng = np.random.default_rng([seed, 61])
    angles = rng.uniform(-1, 1, (count, 2)) * (YAW, PITCH)
    pictures = np.stack([_head(yaw, pitch, rng) for yaw, pitch in np.deg2rad(angles)])
    return np.clip(pictures, 0.02, 1).astype(np.float32), angles


def _head(yaw: float, pitch: float, rng: np.random.Generator) -> Floats:
    """Draw a head that looks to +x (yaw) and up, to -y (pitch); +z is towards the camera."""
    axis = (np.arange(SIZE) + 0.5) * 2 * VIEW / SIZE - VIEW
    shift, size = rng.uniform(-0.1, 0.1, 2), rng.uniform(0.9, 1.1)
    v, u = np.meshgrid((axis - shift[0]) / size, (axis - shift[1]) / size, indexing="ij")
    cos, sin = np.cos((yaw, pitch)), np.sin((yaw, pitch))
    turn = np.array([[cos[0], 0, sin[0]], [0, 1, 0], [-sin[0], 0, cos[0]]])  # about the vertical
    turn = turn @ np.array([[1, 0, 0], [0, cos[1], -sin[1]], [0, sin[1], cos[1]]])
    skull = np.array([0.72, 1.0, 0.85]) * rng.uniform(0.93, 1.07, 3)
    nose = np.array([0.0, 0.12, skull[2]]), np.array([0.13, 0.2, 0.24]) * rng.uniform(0.85, 1.15, 3)
    back = 0.3 + rng.uniform(-0.15, 0.15) + (u * rng.uniform(-1, 1) + v * rng.uniform(-1, 1)) * 0.08
    skin, hair, dark = rng.uniform(0.45, 0.75), rng.uniform(0.06, 0.3), rng.uniform(0.05, 0.15)
    light = np.array([rng.uniform(-0.7, 0.7), rng.uniform(-0.7, 0.2), 1.0])
    light /= np.linalg.norm(light)
    out, depth = back, np.full(u.shape, -np.inf)
    for centre, radii in ((np.zeros(3), skull), nose):
        z, point = _hit(u, v, turn, centre, radii)
        normal = (point - centre) / radii**2
        normal = normal / np.linalg.norm(normal, axis=-1, keepdims=True) @ turn.T
        shade = 0.35 + 0.65 * np.maximum(normal @ light, 0)
        albedo = np.full(u.shape, skin)
        if centre[2] == 0:
            x, y, front = point[..., 0], point[..., 1], point[..., 2] > 0
            albedo[(y < -0.5 * skull[1]) | (point[..., 2] < -0.1) & (y < 0.3)] = hair
            albedo[front & (np.hypot((np.abs(x) - 0.28) / 1.4, y + 0.12) < 0.09)] = dark
            albedo[front & (np.abs(x) < 0.24) & (np.abs(y - 0.52) < 0.055)] = dark
        nearer = z > depth
        out, depth = np.where(nearer, albedo * shade, out), np.where(nearer, z, depth)
    return out


def _hit(u: Floats, v: Floats, turn: Floats, centre: Floats, radii: Floats) -> tuple[Floats, Floats]:
    """Depth (-inf: none) and point, in the head's own axes, where the ray of a px meets an ellipsoid."""
    start = (np.stack([u, v, np.zeros_like(u)], -1) @ turn - centre) / radii
    way = turn[2] / radii
    a, b, c = way @ way, start @ way, (start**2).sum(-1) - 1
    root = b * b - a * c
    z = np.where(root > 0, (-b + np.sqrt(np.maximum(root, 0))) / a, -np.inf)
    return z, (start + np.where(root > 0, z, 0)[..., None] * way) * radii + centre


def regress(base: Setting, count: int = HEADS) -> dict[str, Any]:
    """Estimate the angles of held-out heads from every input.

    Returns rows: by input the mean absolute error of both angles in deg, of each, and its cost; pixels: of the first
    heads and their binary frames, with height and width in size. Raises ParameterError.
    """
    base = replace(base, front="image")
    shown, angles = heads(count, base.seed)
    image = chip.read(in_focus(base.sensor, (SIZE, SIZE)), shown, "image", 0, base.noise, base.seed)
    size = gradient.packed_bytes(SIZE * SIZE, 1)
    small = study.reduced(shown, int(size**0.5))
    coarse = chip.read(in_focus(base.sensor, small.shape[1:]), small, "image", 0, base.noise, base.seed)
    codes, few = image.codes.astype(np.float32), coarse.codes.astype(np.float32)
    data = Pictures("heads", np.clip(codes, 0, 255).astype(np.uint8), np.zeros(count, np.int64))
    splits = [data.split(seed) for seed in base.draws]
    active = gradient.spatial(codes, gradient.threshold_of(codes[splits[0][0]], ACTIVE))
    joules = gradient.energy(1, SIZE * SIZE, float(active.mean()))
    inputs = {
        "binary gradient (Eq. A.1)": (active.astype(np.float32), size, (joules, joules)),
        "plain image": (codes, image.bytes, image.energy),
        "plain image, brightness and contrast removed": (_standard(codes), image.bytes, image.energy),
        f"plain image of {few.shape[1]} x {few.shape[2]} px, the same removed": (
            _standard(few),
            coarse.bytes,
            coarse.energy,
        ),
    }
    rows = {}
    with threadpool_limits(1):
        for name, (pictures, frame_bytes, energy) in inputs.items():
            errors, work = [], Work(0, 0.0)
            x = kernel.features(pictures[..., None])
            for seed, (train, test) in zip(base.draws, splits, strict=True):
                model = kernel.regress(x[train], angles[train], seed)
                errors.append(np.abs(model.scores(x[test]) - angles[test]).mean(0))
                work = Work.of(model.flops)
            rows[name] = _row(errors, frame_bytes, energy, work)
    errors = [np.abs(angles[test] - angles[train].mean(0)).mean(0) for train, test in splits]
    rows["mean of the angles to learn from"] = _row(errors, 0, (0.0, 0.0), Work(0, 0.0))
    some = np.vstack([np.hstack([*data.images[:SHOWN]]), np.hstack([*(255 * active[:SHOWN].astype(np.uint8))])])
    return {"rows": rows, "size": list(some.shape), "pixels": some.tobytes().hex()}


def _standard(codes: npt.NDArray[np.float32]) -> npt.NDArray[np.float32]:
    """Every picture with mean 0 and RMS 1."""
    level = codes - codes.mean((1, 2), keepdims=True)
    return level / np.maximum(level.std((1, 2), keepdims=True), 1e-3)


def _row(errors: list[Floats], frame_bytes: float, energy: tuple[float, float], work: Work) -> dict[str, Any]:
    """Figures of the errors (yaw, pitch) of every seed, and what a frame costs."""
    spread = Spread.of(np.mean(errors, 1))
    yaw, pitch = np.mean(errors, 0)
    error = {"error_deg": spread.mean, "error_deg_std": spread.std, "yaw_deg": float(yaw), "pitch_deg": float(pitch)}
    cost = {"bytes": frame_bytes, "energy_uj": [1e6 * e for e in energy], "network_uj": 1e6 * work.joules}
    return error | cost
