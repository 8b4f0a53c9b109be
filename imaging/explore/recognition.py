"""The task of recognition: pictures classified from the chip's bytes."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from talbot.base.kept import afresh
from talbot.imaging.explore import costs
from talbot.imaging.explore.space import TILE, TILES, Point, Space
from talbot.imaging.explore.task import FULL, LANES, Fidelity, Outcome
from talbot.imaging.frame.request import FrameRequest
from talbot.imaging.recognize import chip, data, study
from talbot.models.parameters import STANDARD, SensorParameters
from talbot.models.recognition.optics import Display

FRONTS = "asp", "ternary", "image"  # of `study`, those that this chip reads
OPTICAL = "scale", "blur", "threshold"  # of no effect on a plain image


@dataclass(frozen=True)
class Recognition:
    """Pictures classified from the chip's bytes. data: as DATA of `make recognize`."""

    data: str = "digits"
    base: SensorParameters = STANDARD

    name: ClassVar[str] = "recognition"
    about: ClassVar[str] = "1 - accuracy of the kernel classifier, mean over splits"
    extra: ClassVar[Sequence[str]] = ("total_uj",)  # of the sensor and the classifier
    thesis: ClassVar[Mapping[str, Any]] = {"front": "asp", "scale": 6, "blur": 4.0, "threshold": 10}
    SOME: ClassVar[int] = 400  # pictures of the small fidelity

    @property
    def space(self) -> Space:
        """What is sent, optics as a first layer, converters."""
        return {
            "front": list(FRONTS),
            "scale": (2, 8),
            "blur": (0.5, 8.0),
            "threshold": (2, 40),
            TILE: list(TILES),
            "chip.lanes": LANES,
        }

    def effective(self, values: Mapping[str, Any]) -> Mapping[str, Any]:
        """Without the optics' settings and the threshold for a plain image."""
        plain = values.get("front") == "image"
        return {name: value for name, value in values.items() if not plain or name not in OPTICAL}

    def sensor(self, point: Point) -> SensorParameters:
        """With an array that a picture fills."""
        return chip.sized(self._display(point))

    def requests(self, point: Point) -> Sequence[FrameRequest]:
        """A frame of a picture."""
        setting = self._setting(point, 1, 1)
        return [chip.frame_request(self._display(point), setting.mode, setting.threshold, 1.0, 1)]

    def _display(self, point: Point) -> Display:
        shape: Any = data.load(self.data).images.shape[1:]
        setting = self._setting(point, 1, 1)
        if not setting.by_optics:
            return study.in_focus(point.sensor, shape)
        return study.out_of_focus(point.sensor, shape, setting.scale, setting.blur)

    def _setting(self, point: Point, seed: int, seeds: int) -> study.Setting:
        return study.Setting(sensor=point.sensor, seed=seed, seeds=seeds, **point.settings)

    def evaluate(self, point: Point, fidelity: Fidelity, seed: int) -> Outcome:
        """Of full: all pictures, three splits; of small: some of them, one."""
        whole = fidelity.part == FULL.part
        pictures = data.load(self.data).part(None if whole else self.SOME)
        setting = self._setting(point, seed, 3 if whole else 1)
        with afresh():
            evaluation = study.evaluate(setting, pictures)
            frames = self.requests(point)
            mode, threshold = frames[0].frame.mode, setting.threshold
            shown = chip.read(self._display(point), pictures.radiance[:4], mode, threshold, 1.0, seed).codes
        known = costs.least(frames)
        figures = {
            "error": 1 - float(np.mean(evaluation["accuracies"])),
            "energy_uj": evaluation["energy_uj"][0],
            "total_uj": evaluation["energy_uj"][0] + evaluation["network_uj"],
            "bytes": evaluation["bytes"],
            "frames_per_s": known["frames_per_s"],
        }
        return Outcome(figures, np.concatenate(shown, 1).astype(float))

    def free_error(self) -> float | None:
        """The most frequent class."""
        labels = data.load(self.data).labels
        return 1 - float(np.bincount(labels).max() / len(labels))

    def words(self, point: Point) -> str:
        """`make recognize` with the point's settings."""
        s = point.settings
        words = [f"{name.upper()}={s[name]}" for name in ("front", *OPTICAL) if name in s]
        return " ".join(["make recognize", f"DATA={self.data}", "CURVES=none", *words])

    def content(self) -> Sequence[object]:
        """The data, a file or folder by its content."""
        return (self.data, *([Path(self.data)] if Path(self.data).exists() else []))
