"""Recognition of one's own pictures through the sensor, by the same functions as `make recognize`."""

import tempfile
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from talbot.api.sensor import Sensor
from talbot.imaging.recognize import data, study
from talbot.imaging.recognize.job import Study, measure
from talbot.imaging.recognize.study import Setting
from talbot.models.parameters import ParameterError, check_choice
from talbot.models.recognition.network import Network
from talbot.models.scene.resample import linear

SHIPPED = 8  # px, of the pictures that the shipped weights know


@dataclass(frozen=True, eq=False, repr=False)
class Recognition:
    """Pictures as the chip sends them, classified.

    features: (n, height, width, channels), for a network of one's own. classes: the answer for each picture, (n,).
    labels: the truth, None without. test: which pictures were not trained on. summary: figures, as in summary.json.
    """

    features: npt.NDArray[np.float32]
    classes: npt.NDArray[np.intp]
    labels: npt.NDArray[np.int64] | None
    test: npt.NDArray[np.bool_]
    summary: dict[str, Any]

    def __repr__(self) -> str:
        accuracy = f", accuracy {100 * self.summary['accuracy']:.2f} %" if "accuracy" in self.summary else ""
        return f"<Recognition of {len(self.classes)} pictures{accuracy}>"


def recognize(
    pictures: str | Path | npt.ArrayLike = "digits",
    labels: npt.ArrayLike | None = None,
    *,
    test: npt.ArrayLike | None = None,
    front: str = "asp",
    sensor: Sensor | None = None,
    **settings: Any,
) -> Recognition:
    """Show pictures to the sensor, train a classifier on what its golden chip sends, and test it.

        result = talbot.recognize(images, labels, front="ternary", threshold=8)
        result.summary["accuracy"], result.summary["baselines"], result.features

    pictures: as DATA of `make recognize`, or an array (n, height, width) of uint8 sRGB codes. labels: (n,), 0 and up;
    without them the shipped digits' weights answer, for a picture of a bright digit on black that fills it, of any
    size. test: bool (n,), a test set instead of random fifths. front: asp, ternary, gradient or image. settings:
    scale, blur, threshold, noise, seed, seeds, classifier, epochs, ... (`talbot.imaging.recognize.study.Setting`).

    Raises ParameterError.
    """
    known = Setting.__dataclass_fields__.keys() - {"sensor", "front", "bytes"}
    for name in settings:
        check_choice("setting", name, sorted(known))
    base = Setting(sensor=sensor.parameters, **settings) if sensor else Setting(**settings)
    if not isinstance(pictures, str | Path):
        images = np.asarray(pictures)
        if images.dtype != np.uint8 or images.ndim != 3 or min(images.shape) < 1:
            raise ParameterError(f"pictures = {images.dtype} {images.shape}: must be uint8 (n, height, width)")
        if labels is None:
            return _shipped(images, front, settings, sensor)
        chosen = None if test is None else np.asarray(test, bool)
        labels = np.asarray(labels)
        if labels.dtype.kind not in "iu":
            raise ParameterError(f"labels = {labels.dtype}: must be integers")
        pictured = data.checked(data.Pictures("own", images, labels.astype(np.int64), chosen))
    else:
        if labels is not None or test is not None:
            raise ParameterError(f"labels: must be left out, {str(pictures)!r} has its own")
        pictured = data.load(str(pictures))
    task = Study(pictured, (front,), base, verilog=False, workers=1)
    with tempfile.TemporaryDirectory(prefix="talbot-") as folder:
        measured = measure(task, Path(folder))
    lead = replace(base, front=front)
    features = study.see(lead, pictured.radiance).channels
    classify, _ = study.trained(lead, features, pictured, base.seed)
    held = np.zeros(len(features), bool)
    held[pictured.split(base.seed)[1]] = True
    return Recognition(features, classify(features), pictured.labels, held, measured.summary)


def _shipped(images: npt.NDArray[np.uint8], front: str, settings: dict[str, Any], sensor: Sensor | None) -> Recognition:
    if front != "asp" or settings or sensor:
        raise ParameterError("labels = None: must be given, unless front, sensor and settings are the default")
    lit = linear(images.reshape(len(images), -1)).reshape(images.shape)
    small = study.reduced(lit, SHIPPED)
    seen = study.see(Setting(), small)
    net: Network = study.network(Setting(), seen.channels.shape[1:], 10, 1)
    net.load(study.WEIGHTS)
    summary = {"bytes": seen.bytes, "energy_uj": [1e6 * e for e in seen.energy]}
    return Recognition(seen.channels, net.classify(seen.channels), None, np.ones(len(images), bool), summary)
