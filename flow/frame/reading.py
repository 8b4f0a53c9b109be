"""One frame of the chip for a reconstruction: `talbot lightfield`, `polar` and `depth` from their options to files."""

import json
from argparse import ArgumentParser, Namespace
from collections.abc import Callable, Sequence
from pathlib import Path
from types import ModuleType
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from talbot.base.files import check_folder, staged
from talbot.base.page import Tile
from talbot.models.parameters import STANDARD, SensorParameters, read_sensor
from talbot.models.reconstruct import FULL

from . import arguments as text
from .figures import mismatches
from .request import FrameRequest, request
from .result import FrameResult, GoldenResult

HEADROOM = 5.0  # LSB below a full code, for noise and bow of the converters: what is above counts as full
Note = Callable[[str], None]


class Found(Protocol):
    """What a reconstruction gives: its figures are ``summary``."""

    @property
    def summary(self) -> dict[str, Any]:
        """Of summary.json."""
        ...


def add_arguments(parser: ArgumentParser, command: str, scene: str) -> None:
    """Options of the scene, the sensor and the noise: texts, checked by `asked`."""
    add = parser.add_argument
    add("--scene", default=scene, help=f"name of a scene, an image, or a light field, as for talbot sim ({scene})")
    add("--depth", help="depth file for --scene (models/scene/README.md)")
    add("--sensor", help="sensor file; talbot sensor prints one to start from")
    add("--rows", help="pixels, 1..1024 (default: of the sensor)")
    add("--cols", help="pixels, 1..1536 (default: of the sensor)")
    add("--noise", default="1.0", help="times the physical noise, 0..100")
    add("--seed", default="1", help="of every random draw, 0..4294967295")
    add("--golden", action="store_true", help="by the golden chip alone, without its Verilog")
    add("--out", help=f"folder for the results (default: build/{command}/<scene>)")


def asked(options: Namespace, command: str, mode: str, sensor: SensorParameters | None = None) -> FrameRequest:
    """The request of `add_arguments`; sensor: None is that of the options. Raises ParameterError."""
    numbers: dict[str, Any] = {}
    for name, high in (("rows", 1024), ("cols", 1536)):
        if getattr(options, name) is not None:
            numbers[name] = text.integer(name, getattr(options, name), 1, high)
    return request(
        scene=options.scene,
        depth=options.depth,
        sensor=sensor or sensor_of(options),
        converter=None if options.sensor else "typical",
        mode=mode,
        noise=text.real("noise", options.noise, 0, 100),
        seed=text.integer("seed", options.seed, 0, 2**32 - 1),
        out=Path(options.out or Path("build") / command / Path(options.scene).stem),
        **numbers,
    )


def sensor_of(options: Namespace, default: SensorParameters = STANDARD) -> SensorParameters:
    """The sensor of the file that ``options`` name, or ``default``. Raises ParameterError."""
    return read_sensor(options.sensor) if options.sensor else default


def write(
    folder: Path, names: Sequence[str], found: Callable[[], Found], page: ModuleType, note: Note
) -> dict[str, Any]:
    """Compute ``found`` and write its page and summary.json into ``folder``, all or nothing; returns the summary."""
    check_folder("out", folder)
    done = found()
    note("report")
    with staged(folder, names) as part:
        page.write(part, done)
        (part / "summary.json").write_text(json.dumps(done.summary, indent=1, allow_nan=False) + "\n")
    return done.summary


def about(result: GoldenResult) -> dict[str, Any]:
    """Figures that every summary has: what was read, and whether chip and golden model agree."""
    scene = result.exposed.scene
    return {
        "scene": result.request.name,
        "rows": scene.shape[0],
        "cols": scene.shape[1],
        "views": scene.views,
        "noise": result.request.noise,
        "seed": result.request.seed,
        "chip": isinstance(result, FrameResult),
        "stream_mismatches": mismatches(result.stream, result.golden.stream),
        "decoded_mismatches": int((result.decoded.samples != result.golden.sent).sum()),
    }


def full(samples: npt.NDArray[np.floating], axes: tuple[int, ...]) -> npt.NDArray[np.bool_]:
    """Where any of the samples along ``axes``, in LSB, is full: what else it holds is not known."""
    return np.asarray((samples > FULL - HEADROOM).any(axes))


def rms(error: npt.NDArray[np.floating]) -> float | None:
    """Root of the mean square; None of nothing."""
    return float(np.sqrt(np.mean(error**2))) if error.size else None


def line(s: dict[str, Any]) -> str:
    """What a page says below its title of the summary ``s``."""
    by = "the chip's Verilog" if s["chip"] else "the golden model"
    return f"{s['rows']} x {s['cols']} pixels, {s['views']} x {s['views']} views, noise {s['noise']:g}, by {by}"


def differs(s: dict[str, Any]) -> bool:
    """Whether chip and golden model differ in the summary ``s``."""
    return bool(s["stream_mismatches"] or s["decoded_mismatches"])


def agreement(s: dict[str, Any]) -> Tile:
    """Whether chip and golden model agree."""
    wrong = differs(s)
    return Tile("differs" if wrong else "byte for byte", "chip against golden model", "bad" if wrong else "good")


def number(value: float | None, digits: int = 2, unit: str = "") -> str:
    """A figure, '-' where there is none."""
    return "-" if value is None else f"{value:.{digits}f}{unit}"
