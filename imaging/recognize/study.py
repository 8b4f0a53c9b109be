"""Accuracy of one way to see and to classify, from pictures to figures; a table and curves are lists of these."""

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
from threadpoolctl import threadpool_limits

from talbot.base.jobs import Job
from talbot.base.jobs import run as run_jobs
from talbot.imaging.recognize import chip
from talbot.imaging.recognize.data import Pictures
from talbot.models import recognition
from talbot.models.parameters import (
    STANDARD,
    ParameterError,
    PixelType,
    SensorParameters,
    TileParameters,
    check_choice,
    check_int,
)
from talbot.models.parameters.stream_format import HEADER_BYTES, TRAILER_BYTES
from talbot.models.recognition import gradient, kernel
from talbot.models.recognition.network import Conv, Network, lenet
from talbot.models.recognition.optics import Display, phase_types
from talbot.models.recognition.statistics import Spread, first_layer_flops

FRONTS = "asp", "ternary", "gradient", "image"
FREE = "same_bytes", "random", "chance"  # what costs nothing
WHOLE = "whole"
CLASSIFIERS = "kernel", "lenet", "binary", "shipped"
WEIGHTS = Path(recognition.__file__).with_name("digits_lenet.npz")  # docs/results/recognition.md: how it was trained
FILTERS, KERNEL = 12, 5  # of a first layer that is computed
GRADIENT = 0.2  # threshold of the gradient, of white
WHITE = 255 * 0.5  # codes of white in image mode, at the default light
MAC, ADD = 0.23e-12, 0.03e-12  # J, at 45 nm, 8 bits: multiplication and addition, addition [Horowitz2014]
SIX = (2, 3)  # tile of six random types


@dataclass(frozen=True)
class Setting:
    """A front and a classifier with their parameters.

    front: asp, ternary, gradient, image; whole (an image by the array of asp); same_bytes (an image of at most
    ``bytes``), random or learned (filters on the image). scale: sensor px along a picture px. blur: of a point, in
    picture px, positive behind the focal plane.
    threshold: codes. bits: of a code that are kept; levels: bits of the gradient. snr_db, snr_train_db: of white noise
    in the pictures that are tested and trained on, None for none. noise: times the physical noise. ideal: neither noise
    nor converters. draw: of random pixel types, 0 for the sensor's. seeds: splits and draws, from ``seed`` on.
    classifier: kernel; lenet, trained for ``epochs`` on pictures moved by up to ``shift`` px; binary, one of
    binary weights; shipped, a lenet of digits trained on the split of seed 1.
    """

    sensor: SensorParameters = STANDARD
    front: str = "asp"
    scale: int = 6
    blur: float = 4.0
    threshold: int = 10
    bits: int = 8
    levels: int = 1
    snr_db: float | None = None
    snr_train_db: float | None = None
    noise: float = 1.0
    ideal: bool = False
    draw: int = 0
    bytes: float = 0.0
    seed: int = 1
    seeds: int = 3
    classifier: str = "kernel"
    epochs: int = 20
    shift: int = 0

    def __post_init__(self) -> None:
        check_choice("front", self.front, (*FRONTS, *FREE, WHOLE, "learned"))
        check_choice("classifier", self.classifier, CLASSIFIERS)
        check_int("seed", self.seed, 0, 1 << 31)
        check_int("seeds", self.seeds, 1, 100)
        check_int("epochs", self.epochs, 1, 1000)
        check_int("shift", self.shift, 0, 4)
        check_int("bits", self.bits, 1, 8)
        check_int("threshold", self.threshold, 0, 127)
        if self.classifier == "shipped" and (self.seed, self.seeds, self.front) != (1, 1, "asp"):
            raise ParameterError("classifier = 'shipped': must be with front asp, seed 1 and one seed: of its training")
        if self.front == "learned" and self.classifier == "kernel":
            raise ParameterError("front = 'learned': must be with classifier lenet or binary, which learn it")

    @property
    def text(self) -> str:
        """All values, for the key of a result."""
        return json.dumps(asdict(self), default=str)

    @property
    def draws(self) -> range:
        """Seeds of the splits and draws."""
        return range(self.seed, self.seed + self.seeds)

    @property
    def by_optics(self) -> bool:
        """Whether the optics is the first layer."""
        return self.front in ("asp", "ternary")

    @property
    def mode(self) -> str:
        """Mode of the sensor's frames."""
        return "ternary" if self.front == "ternary" else "edge" if self.by_optics else "image"


@dataclass(frozen=True, eq=False)
class Seen:
    """Channels (n, height, width, channels) of a network, and what a frame costs.

    bytes: of a frame. energy: in J, lower and higher reading. share: of the samples, not 0. first: operations of the
    first layer, outside of the optics. image_energy: of the same frame with every sample converted, or None.
    """

    channels: npt.NDArray[np.float32]
    bytes: float
    energy: tuple[float, float]
    share: float = 1.0
    first: int = 0
    image_energy: tuple[float, float] | None = None


def in_focus(sensor: SensorParameters, shape: tuple[int, int]) -> Display:
    """Return a picture that fills the array, a sensor px for each of its px."""
    return Display(sensor, shape, 1, 0.0, 0)


def out_of_focus(sensor: SensorParameters, shape: tuple[int, int], scale: int, blur: float) -> Display:
    """Return a picture before the optics as a first layer. blur: in picture px."""
    return Display(sensor, shape, scale, blur * scale)


def see(setting: Setting, radiance: npt.NDArray[np.float32]) -> Seen:
    """Return the network's input for pictures (n, height, width), by a front of the setting. Raises ParameterError."""
    if setting.by_optics:
        return _edges(setting, radiance)
    shape: tuple[int, int] = radiance.shape[1:]  # pyright: ignore[reportAssignmentType]
    if setting.front == "same_bytes":
        radiance = reduced(radiance, image_size(setting, shape))
    height, width = radiance.shape[1:]
    display = in_focus(setting.sensor, (height, width))
    if setting.front == WHOLE:
        display = out_of_focus(setting.sensor, (height, width), setting.scale, 0.0)
    reading = chip.read(display, radiance, "image", 0, setting.noise, setting.seed)
    margin, scale = display.margin, display.scale
    cells = reading.codes.reshape(-1, height + 2 * margin, scale, width + 2 * margin, scale)
    codes = cells.mean((2, 4), dtype=np.float32)[:, margin : margin + height, margin : margin + width, None]
    if setting.front == "gradient":
        active = gradient.levels(reading.codes, setting.levels, GRADIENT * WHITE)
        share = float((active > 0).mean())
        joules = gradient.energy(setting.levels, height * width, share)
        size = gradient.packed_bytes(height * width, setting.levels)
        return Seen(active[..., None].astype(np.float32), size, (joules, joules), share)
    filters = setting.front in ("random", "learned") or setting.classifier != "kernel"
    first = first_layer_flops(height, width, KERNEL, FILTERS) if filters else 0
    return Seen(codes, reading.bytes, reading.energy, first=first)


def _edges(setting: Setting, radiance: npt.NDArray[np.float32]) -> Seen:
    sensor = replace(setting.sensor, tile=random_tile(setting.draw)) if setting.draw else setting.sensor
    shape: tuple[int, int] = radiance.shape[1:]  # pyright: ignore[reportAssignmentType]
    display = out_of_focus(sensor, shape, setting.scale, setting.blur)
    types = phase_types(sensor)
    if setting.ideal:
        pair = display.currents(radiance)
        samples = len(types) / sensor.tile.n_types * np.prod(display.size)
        return Seen(display.channels(pair[:, 0] - pair[:, 1], types), float(samples), (0.0, 0.0))
    mode = setting.mode
    reading = chip.read(display, radiance, mode, setting.threshold, setting.noise, setting.seed)
    codes = reading.codes
    if mode == "edge" and setting.bits < 8:
        step = 1 << 8 - setting.bits
        codes = np.sign(codes) * (np.abs(codes) // step * step)
    size = reading.bytes * (setting.bits / 8 if mode == "edge" else 1)
    return Seen(display.channels(codes, types), size, reading.energy, reading.share, 0, reading.image_energy)


def random_tile(draw: int) -> TileParameters:
    """Six random types: beta in 5..50, any orientation, alpha 0 [Jayasuriya2017, Sec. 6.4.4]."""
    rng = np.random.default_rng([draw, 56])
    kinds = [PixelType(float(rng.uniform(5, 50)), float(rng.uniform(-90, 90)), 0.0) for _ in range(SIX[0] * SIX[1])]
    return TileParameters.of_rows([kinds[: SIX[1]], kinds[SIX[1] :]])


def image_size(setting: Setting, shape: tuple[int, int]) -> int:
    """Edge of the largest square picture in ``setting.bytes`` of the chip, at most the picture's, at least 2."""
    frame = HEADER_BYTES + TRAILER_BYTES + 4  # marks (docs/stream.md)
    return int(np.clip(np.sqrt(max(setting.bytes - frame, 0)), 2, min(shape)))


def reduced(pictures: npt.NDArray[np.float32], size: int) -> npt.NDArray[np.float32]:
    """Pictures (n, height, width) as a camera of size x size pixels sees them: means over the pixels' areas."""
    out = pictures
    for axis in (1, 2):
        count = out.shape[axis]
        edges = np.arange(size + 1) * count / size
        cells = np.arange(count)
        overlap = np.minimum(edges[1:, None], cells + 1) - np.maximum(edges[:-1, None], cells)
        weights = (np.maximum(overlap, 0) * size / count).astype(np.float32)
        out = np.moveaxis(np.tensordot(weights, out, (1, axis)), 0, axis)
    return out


def noisy(pictures: npt.NDArray[np.float32], snr_db: float | None, seed: int) -> npt.NDArray[np.float32]:
    """Pictures with additive white noise of an SNR in dB of the mean square, as in [Jayasuriya2017], Fig. 6.6."""
    if snr_db is None:
        return pictures
    rms = float(np.sqrt(np.mean(np.square(pictures, dtype=np.float64)))) * 10 ** (-snr_db / 20)
    noise = np.random.default_rng([seed, 57]).standard_normal(pictures.shape, np.float32)
    return np.clip(pictures + np.float32(rms) * noise, 0, 16).astype(np.float32)


def filtered(images: npt.NDArray[np.float32], seed: int) -> npt.NDArray[np.float32]:
    """Random filters on images (n, height, width, 1): a first layer that nobody chose, (n, height, width, 12)."""
    return Network([Conv(FILTERS, KERNEL)], images.shape[1:], seed).scores(images)


def evaluate(setting: Setting, data: Pictures) -> dict[str, Any]:
    """Train and test for every seed: accuracies, bytes, energies and operations. Raises ParameterError."""
    if setting.front == "chance":
        tests = [data.labels[data.split(seed)[1]] for seed in setting.draws]
        most = [float(np.bincount(labels).max() / len(labels)) for labels in tests]  # the most frequent class
        return {"accuracies": most, "bytes": 0.0, "energy_uj": [0.0, 0.0], "share": 0.0} | _operations(0, Work(0, 0.0))
    with threadpool_limits(1):
        test = see(setting, noisy(data.radiance, setting.snr_db, setting.seed))
        train = test
        if setting.snr_train_db != setting.snr_db:
            train = see(setting, noisy(data.radiance, setting.snr_train_db, setting.seed + 1))
        return scored(setting, data, train, test)


def scored(setting: Setting, data: Pictures, train: Seen, test: Seen) -> dict[str, Any]:
    """Train on ``train`` and test on ``test``, which hold all pictures of ``data``, for every seed."""
    right, work, seconds = [], Work(0, 0.0), 0.0
    for seed in setting.draws:
        start = perf_counter()
        classify, work = trained(setting, train.channels, data, seed)
        seconds += perf_counter() - start
        chosen = data.split(seed)[1]
        right.append(float((classify(test.channels[chosen]) == data.labels[chosen]).mean()))
    out = {"accuracies": right, "bytes": test.bytes, "energy_uj": [1e6 * e for e in test.energy], "share": test.share}
    if test.image_energy:
        out["image_mode_uj"] = [1e6 * e for e in test.image_energy]
    return out | _operations(test.first, work) | {"train_s": seconds / setting.seeds}


class Work(NamedTuple):
    """Operations of a picture behind the first layer, and their energy in J."""

    operations: int
    joules: float

    @classmethod
    def of(cls, operations: int, additions: int = 0) -> "Work":
        """Return the work of operations, of which some are additions alone."""
        return cls(operations, MAC * (operations - additions) + ADD * additions)


def _operations(first: int, behind: Work) -> dict[str, Any]:
    total, joules = first + behind.operations, MAC * first + behind.joules
    return {"flops_first_layer": first, "flops_total": total, "network_uj": 1e6 * joules}


def trained(
    setting: Setting, channels: npt.NDArray[np.float32], data: Pictures, seed: int
) -> tuple[Callable[[npt.NDArray[np.float32]], npt.NDArray[np.intp]], Work]:
    """Return a classifier of channels, and its work for a picture."""
    chosen = data.split(seed)[0]
    labels = data.labels[chosen]
    if setting.classifier != "kernel":
        net = network(setting, channels.shape[1:], data.classes, seed)
        if setting.classifier == "shipped":
            net.load(WEIGHTS)
        else:
            net.train(channels[chosen], labels, setting.epochs, setting.shift)
        behind = net.flops - (0 if setting.by_optics else net.products[0])
        return net.classify, Work.of(behind, net.additions)

    def rows(x: npt.NDArray[np.float32]) -> npt.NDArray[np.float32]:
        return kernel.features(filtered(x, seed) if setting.front == "random" else x)

    classifier = kernel.train(rows(channels[chosen]), labels, data.classes, seed)
    return lambda x: classifier.classify(rows(x)), Work.of(classifier.flops)


def network(setting: Setting, shape: tuple[int, ...], classes: int, seed: int) -> Network:
    """Return a LeNet whose first layer is the optics, or 12 filters; random ones stay as they are drawn."""
    first = [] if setting.by_optics else [Conv(FILTERS, KERNEL, fixed=setting.front == "random")]
    return Network(lenet(shape[0], classes, first, setting.classifier == "binary"), shape, seed)


@dataclass(frozen=True)
class Point:
    """A point of a curve: where it is on the axis, and its setting."""

    x: float
    setting: Setting


def curves(base: Setting, names: Sequence[str], draws: int) -> dict[str, dict[str, list[Point]]]:
    """Settings of the curves by name, then by line."""
    image = replace(base, front="image")
    out: dict[str, dict[str, list[Point]]] = {}
    for name in names:
        if name == "threshold":
            values = (0, 5, 10, 20, 40)
            fronts = {"ASP": replace(base, front="asp"), "ternary": replace(base, front="ternary")}
            out[name] = {
                front: [Point(v, replace(s, threshold=v)) for v in values if v or front == "ASP"]
                for front, s in fronts.items()
            }
        elif name == "bits":
            asp, binary = replace(base, front="asp", threshold=0), replace(base, front="gradient")
            out[name] = {
                "ASP": [Point(b, replace(asp, bits=b)) for b in (3, 4, 6, 8)],
                "gradient": [Point(b, replace(binary, levels=b)) for b in (1, 2, 4, 8)],
            }
        elif name == "snr":
            values = (9, 12, 15, 20, 28)
            asp = replace(base, front="asp")
            out[name] = {
                "ASP": [Point(v, replace(asp, snr_db=v)) for v in values],
                "ASP, trained with it": [Point(v, replace(asp, snr_db=v, snr_train_db=v)) for v in values],
                "image": [Point(v, replace(image, snr_db=v)) for v in values],
                "image, trained with it": [Point(v, replace(image, snr_db=v, snr_train_db=v)) for v in values],
            }
        elif name == "blur":
            out[name] = {"ASP": [Point(v, replace(base, front="asp", blur=v)) for v in (0.5, 1, 2, 4, 6, 8)]}
        elif name == "draws":
            draw = replace(base, front="asp", ideal=True, seeds=1)
            out[name] = {"six random types": [Point(d, replace(draw, draw=d)) for d in range(1, draws + 1)]}
    return out


CURVES = "threshold", "bits", "snr", "blur", "draws"


def run(
    settings: Mapping[str, Setting], data: Pictures, folder: Path, title: str, workers: int
) -> dict[str, dict[str, Any]]:
    """Evaluate settings, each kept in ``folder``; names are of files. Raises ParameterError."""
    digest = data.digest
    jobs = [Job(name, evaluate, (setting, data), (digest, setting.text)) for name, setting in settings.items()]
    return dict(zip(settings, run_jobs(jobs, folder, title, workers), strict=True))


def figures(result: Mapping[str, Any]) -> dict[str, Any]:
    """Return a result with the mean and the spread of its accuracies."""
    spread = Spread.of(result["accuracies"])
    return {"accuracy": spread.mean, "accuracy_std": spread.std} | dict(result)
