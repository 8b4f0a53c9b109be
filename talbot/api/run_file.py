"""Runs in files: everything of a frame, and files for other programs."""

import gzip
import json
import pickle
from collections.abc import Mapping
from contextlib import ExitStack
from pathlib import Path
from typing import Any

from talbot.base.files import atomic, check_file, staged
from talbot.imaging.frame.result import GoldenResult
from talbot.models.parameters import ParameterError, sensor_text

FORMAT = "talbot run 1"
FILE = "run.gz"
BESIDE = "stream.bin", "decoded.npz", "sensor.toml", "summary.json"
# What a file may hold beside talbot's classes, so that an unknown one is no program
PLAIN = {
    "builtins": {"set", "frozenset", "slice", "range", "complex", "bytearray"},
    "collections": {"OrderedDict"},
    "numpy": {"ndarray", "dtype"},
    "numpy._core.multiarray": {"_reconstruct", "scalar"},
    "numpy._core.numeric": {"_frombuffer"},
    "pathlib": {"Path", "PosixPath", "WindowsPath"},
    "pathlib._local": {"Path", "PosixPath", "WindowsPath"},
}


class _Reader(pickle.Unpickler):
    def find_class(self, module: str, name: str) -> Any:
        """Return a class of talbot, or one of `PLAIN`."""
        if name in PLAIN.get(module, ()):
            return super().find_class(module, name)
        if module.startswith("talbot.") and "." not in name:
            known = super().find_class(module, name)
            if isinstance(known, type) and known.__module__ == module:
                return known
        raise pickle.UnpicklingError(f"holds {module}.{name}")


def write_run(path: Path, result: GoldenResult, summary: Mapping[str, Any]) -> None:
    """Write a run to a file, or to a folder where the name has no suffix. Raises ParameterError, OSError."""
    text = sensor_text(result.request.sensor)  # refuses a response that is a function
    with ExitStack() as stack:
        if path.suffix:
            check_file("path", path)
            part = stack.enter_context(atomic(path))
        else:
            folder = stack.enter_context(staged(path, [FILE, *BESIDE]))
            (folder / "stream.bin").write_bytes(result.stream)
            result.decoded.save(folder / "decoded.npz")
            (folder / "sensor.toml").write_text(text, encoding="utf-8")
            (folder / "summary.json").write_text(json.dumps(summary, indent=1) + "\n", encoding="utf-8")
            part = folder / FILE
        with gzip.open(part, "wb", 1) as file:
            pickle.dump((FORMAT, result, dict(summary)), file, 5)


def read_run(path: Path) -> tuple[GoldenResult, dict[str, Any]]:
    """Return the result and the summary in a file or folder of `write_run`. Raises ParameterError."""
    file = path / FILE if path.is_dir() else path
    if not file.is_file():
        raise ParameterError(f"path = {str(path)!r}: no such file; must be a file or folder of Run.save")
    try:
        with gzip.open(file) as opened:
            name, result, summary = _Reader(opened).load()
            opened.read()  # to the end, where gzip checks its CRC
        if name != FORMAT or not isinstance(result, GoldenResult):
            raise pickle.UnpicklingError(f"holds {name!r}")
    except ParameterError:
        raise
    except Exception as error:  # a damaged pickle may raise any
        text = " ".join(str(error).split()) or type(error).__name__
        raise ParameterError(f"path = {str(path)!r}: must be a file or folder of Run.save ({text})") from None
    return result, summary
