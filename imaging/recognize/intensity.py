"""Intensity from one binary gradient frame [Jayasuriya2017, Sec. A.5], next to edges, to gray and to JPEG."""

from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt
from threadpoolctl import threadpool_limits

from talbot.imaging.frame.codecs import GAMMA, coded
from talbot.imaging.frame.quality import ssim
from talbot.imaging.recognize.data import Pictures
from talbot.imaging.recognize.study import WHITE, Setting, see
from talbot.models.recognition import gradient, kernel
from talbot.models.recognition.poisson import differences, integrate, smooth
from talbot.models.recognition.statistics import Spread
from talbot.models.reconstruct import psnr_without_mean_db
from talbot.models.scene import Sampling
from talbot.models.scene import load as load_scene
from talbot.models.scene.photograph import PHOTOGRAPHS
from talbot.models.scene.rendered import RENDERED

ACTIVE = 0.2  # of the pixels of the pictures to learn from: sets the threshold; [Jayasuriya2017] has 0.1 to 0.25
SCREEN, SPREAD = 0.01, 0.1  # of Poisson's equation, 1/px^2
RIDGE = 0.1  # of the kernel
FACES = 100  # of scikit-image's part of [Huang2007]
SCENE = 64  # px, of a photograph or a rendered scene
SHOWN, SHEET = 6, 100  # pictures on the page, in a file of JPEG
BINARY, EDGES = "binary frame", "Canny edges"
SMALL, JPEG = "plain image in as many bytes, enlarged", "JPEG in as many bytes"
POISSON, TERNARY = f"{BINARY}, Poisson", "ternary differences along x and y, Poisson"
LEARNED = {source: f"{source}, kernel regression" for source in (BINARY, EDGES)}
PLAIN_EDGES = f"{EDGES} as they are"
OF_BINARY, OF_IMAGE = (POISSON, LEARNED[BINARY]), (LEARNED[EDGES], PLAIN_EDGES, SMALL, JPEG)  # by what the sensor takes


def collections(data: Pictures) -> list[Pictures]:
    """Return ``data``, faces, and scenes."""
    from skimage.data import lfw_subset  # it imports for long

    faces = np.rint(255 * lfw_subset()[:FACES]).astype(np.uint8)
    names = ("motorcycle", *PHOTOGRAPHS, *RENDERED)
    light = np.stack([load_scene(name, Sampling(SCENE, SCENE, 1)).image for name in names])
    scenes = np.rint(255 * np.clip(light, 0, 1) ** (1 / GAMMA)).astype(np.uint8)
    named = {"faces": faces, "photographs": scenes}
    return [data, *(Pictures(name, images, np.zeros(len(images), np.int64)) for name, images in named.items())]


def recover(base: Setting, data: Pictures) -> dict[str, Any]:
    """Recover every held-out picture by every method, for every seed's split.

    A picture has the mean of the truth; its contrast is one factor that fits the pictures to learn from best. Returns
    rows: figures by method; methods: of the first seed's `sheet`, which is in pixels, with its height and width in
    size. Raises ParameterError.
    """
    from skimage.feature import canny  # it imports for long

    truth = data.radiance
    seen = see(replace(base, front="image"), truth)
    light, pixels = seen.channels[..., 0] / WHITE, truth[0].size
    edges = np.stack([canny(picture.astype(float)) for picture in light])
    bits = gradient.packed_bytes(pixels, 1)
    scores: dict[str, list[tuple[float | None, float | None]]] = {}
    share: list[float] = []
    shown: dict[str, npt.NDArray[Any]] = {}
    with threadpool_limits(1):
        for seed in base.draws:
            train, test = data.split(seed)
            threshold = gradient.threshold_of(light[train], ACTIVE)
            active = gradient.spatial(light, threshold)
            dx, dy = (np.sign(d) * (np.abs(d) > threshold) for d in differences(light))
            estimates = {
                POISSON: smooth(active, SPREAD),
                TERNARY: integrate(dx, dy, SCREEN),
                **_learned(truth, train, {BINARY: active, EDGES: edges}),
                PLAIN_EDGES: edges,
                "gray": np.zeros(truth.shape),
            }
            share.append(float(active[test].mean()))
            images = {name: _contrast(u, truth, train) * u[test] for name, u in estimates.items()}
            images[SMALL] = _reduced(truth[test], bits)
            if (jpeg := _jpeg(truth[test], bits)) is not None:
                images[JPEG] = jpeg
            for name, estimate in images.items():
                scores.setdefault(name, []).append(_score(estimate, truth[test]))
            if not shown:
                shown = {"picture": truth[test], BINARY: active[test]} | images
    joules = gradient.energy(1, pixels, float(np.mean(share)))
    scores.setdefault(JPEG, [(None, None)])  # no JPEG is that small
    rows = {name: _figures(pairs) | _cost(name, bits, joules, seen.energy) for name, pairs in scores.items()}
    drawn = sheet(shown)
    return {"rows": rows, "methods": list(shown), "size": list(drawn.shape), "pixels": drawn.tobytes().hex()}


def sheet(shown: dict[str, npt.NDArray[Any]]) -> npt.NDArray[np.uint8]:
    """Draw some pictures of every method below one another, in codes; all but bits have the mean of the first row."""
    truth = next(iter(shown.values()))[:SHOWN]
    lines = [
        np.hstack([*(some if some.dtype == bool else _level(some) + truth.mean((1, 2), keepdims=True))])
        for some in (pictures[:SHOWN] for pictures in shown.values())
    ]
    return np.rint(255 * np.clip(np.vstack(lines), 0, 1) ** (1 / GAMMA)).astype(np.uint8)


def _learned(
    truth: npt.NDArray[np.float32], train: npt.NDArray[np.intp], frames: dict[str, npt.NDArray[np.bool_]]
) -> dict[str, npt.NDArray[np.floating]]:
    """All pictures by regression of those to learn from: their mean, and what each kind of frames adds to it."""
    mean = truth[train].mean(0)
    residual = _level(truth[train] - mean).reshape(len(train), -1)
    out = {}
    for name, bits in frames.items():
        x = bits.reshape(len(bits), -1).astype(np.float32)
        added = kernel.regress(x[train], residual, ridge=RIDGE).scores(x)
        out[LEARNED[name]] = mean + added.reshape(truth.shape)
    return out | {"mean of the pictures to learn from": np.broadcast_to(mean, truth.shape)}


def _reduced(pictures: npt.NDArray[np.float32], size: int) -> npt.NDArray[np.floating]:
    """Pictures in at most ``size`` px of a byte each, enlarged again."""
    from skimage.transform import resize, resize_local_mean  # it imports for long

    height, width = pictures.shape[1:]
    part = np.sqrt(size / (height * width))
    small = resize_local_mean(pictures, (max(int(height * part), 1), max(int(width * part), 1)), channel_axis=0)
    return np.asarray(resize(np.rint(255 * small) / 255, pictures.shape, order=1, anti_aliasing=False))


def _jpeg(pictures: npt.NDArray[np.float32], size: int) -> npt.NDArray[np.floating] | None:
    """Pictures of ``size`` bytes each, many in a file; None where no file is that small."""
    out = []
    for first in range(0, len(pictures), SHEET):
        some = pictures[first : first + SHEET]
        if (file := coded(np.hstack([*some]).astype(float), "jpeg", len(some) * size)) is None:
            return None
        out += np.hsplit(file, len(some))
    return np.stack(out)


def _level(pictures: npt.NDArray[np.floating]) -> npt.NDArray[np.floating]:
    return pictures - pictures.mean((-2, -1), keepdims=True)


def _contrast(
    estimate: npt.NDArray[np.floating], truth: npt.NDArray[np.floating], train: npt.NDArray[np.intp]
) -> float:
    """Return the factor of the estimate that is nearest to the truth of the pictures to learn from."""
    u = _level(estimate[train])
    return float((u * _level(truth[train])).sum() / max(float((u * u).sum()), 1e-9))


def _score(estimates: npt.NDArray[np.floating], truth: npt.NDArray[np.floating]) -> tuple[float | None, float | None]:
    """Mean PSNR in dB and SSIM of the pictures that have them."""
    pairs = [(psnr_without_mean_db(e, t), ssim(e, t)) for e, t in zip(estimates.astype(float), truth.astype(float))]
    columns = ([value for value in column if value is not None] for column in zip(*pairs))
    psnr, similar = (float(np.mean(column)) if column else None for column in columns)
    return psnr, similar


def _figures(pairs: list[tuple[float | None, float | None]]) -> dict[str, Any]:
    out: dict[str, Any] = {}
    for name, column in zip(("psnr_db", "ssim"), zip(*pairs)):
        values = [value for value in column if value is not None]
        out[name], out[f"{name}_std"] = Spread.of(values) if values else (None, None)
    return out


def _cost(name: str, bits: int, joules: float, image: tuple[float, float]) -> dict[str, Any]:
    """Bytes and energy of a method: of nothing, of a frame of one bit, of two ternary differences, of an image."""
    if name in OF_BINARY:
        return {"bytes": bits, "energy_uj": [1e6 * joules] * 2}
    if name == TERNARY:
        return {"bytes": 4 * bits, "energy_uj": [0.0, 0.0]}  # no model
    if name in OF_IMAGE:
        return {"bytes": bits, "energy_uj": [1e6 * e for e in image]}
    return {"bytes": 0, "energy_uj": [0.0, 0.0]}
