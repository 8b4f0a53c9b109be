"""Wake-up: a detector counts changes from frame to frame, in a scene under drifting light."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.ndimage import gaussian_filter

from talbot.imaging.recognize import chip
from talbot.imaging.recognize.study import in_focus, out_of_focus
from talbot.models.parameters import SensorParameters
from talbot.models.recognition import gradient
from talbot.models.recognition.statistics import roc

SIZE, SCALE, BLUR = 16, 6, 4.0  # picture px; sensor px a picture px; picture px
FRAMES = 160  # half of them with an object
CONTRASTS = (0.02, 0.05, 0.1)  # of the object, of white
DRIFT = 0.1  # of the light between two frames, RMS
THRESHOLD = 6  # codes
GRADIENT = 6  # codes


@dataclass(frozen=True, eq=False)
class Watch:
    """Pairs of frames (n, 2, height, width) in linear radiance; events: whether an object is in the second."""

    pairs: npt.NDArray[np.float32]
    events: npt.NDArray[np.bool_]


def background(rng: np.random.Generator) -> npt.NDArray[np.float64]:
    """Draw a smooth background in linear radiance."""
    back = gaussian_filter(rng.standard_normal((SIZE, SIZE)), 3, mode="wrap")
    return 0.4 + 0.05 * back / back.std()


def watch(contrast: float, seed: int) -> Watch:
    """Frames of a smooth background under light that drifts; in half of the pairs a disc of the contrast enters."""
    rng = np.random.default_rng([seed, 59])
    events = np.arange(FRAMES) % 2 == 1
    y, x = np.mgrid[:SIZE, :SIZE]
    pairs = np.empty((FRAMES, 2, SIZE, SIZE), np.float32)
    for i, event in enumerate(events):
        back = background(rng)
        row, col = rng.uniform(4, SIZE - 4, 2)
        disc = np.hypot(y - row, x - col) < rng.uniform(1.5, 3)
        light = 1 + DRIFT * rng.standard_normal(2)
        pairs[i] = [back * light[0], (back + contrast * rng.choice((-1, 1)) * disc * event) * light[1]]
    return Watch(np.clip(pairs, 0.02, 1), events)


def _densest(changes: npt.NDArray[np.bool_], scale: int) -> npt.NDArray[np.float64]:
    """Largest density of changes (n, rows, cols) over a few picture px of ``scale`` px, (n,)."""
    return gaussian_filter(changes.astype(float), (0, 1.5 * scale, 1.5 * scale)).max((1, 2))


def detect(sensor: SensorParameters, contrast: float, seed: int) -> dict[str, Any]:
    """Area below the ROC and energy a frame (uJ) of every detector at one contrast. Raises ParameterError."""
    seen = watch(contrast, seed)
    flat = seen.pairs.reshape(-1, SIZE, SIZE)
    edge = chip.read(out_of_focus(sensor, (SIZE, SIZE), SCALE, BLUR), flat, "ternary", THRESHOLD, 1.0, seed)
    plain = chip.read(in_focus(sensor, (SIZE, SIZE)), flat, "image", 0, 1.0, seed)
    signs = edge.codes.reshape(FRAMES, 2, *edge.codes.shape[1:])
    codes = plain.codes.reshape(FRAMES, 2, SIZE, SIZE).astype(float)
    active = gradient.spatial(codes, GRADIENT)
    changes = gradient.temporal(active[:, 1], active[:, 0])
    level = codes.mean((2, 3), keepdims=True)
    scores = {
        "ternary edges that change": (_densest(signs[:, 1] != signs[:, 0], SCALE), edge.energy, edge.bytes),
        "temporal gradient (Eq. A.2)": (
            _densest(changes, 1),
            (gradient.energy(1, SIZE * SIZE, float(changes.mean())),) * 2,
            gradient.packed_bytes(SIZE * SIZE, 1),
        ),
        "image difference": (np.abs(codes[:, 1] - codes[:, 0]).max((1, 2)), plain.energy, plain.bytes),
        "image difference, brightness removed": (
            np.abs(codes[:, 1] / level[:, 1] - codes[:, 0] / level[:, 0]).max((1, 2)),
            plain.energy,
            plain.bytes,
        ),
        "chance": (np.zeros(FRAMES), (0.0, 0.0), 0.0),
    }
    out: dict[str, Any] = {}
    for name, (score, energy, size) in scores.items():
        curve = roc(score, seen.events)
        out[name] = {
            "auc": curve.area,
            "false": curve.false.tolist(),
            "true": curve.true.tolist(),
            "energy_uj": [1e6 * e for e in energy],
            "bytes": float(size),
        }
    return out
