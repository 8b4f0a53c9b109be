"""The codes that the formats are measured on."""

import zipfile
from dataclasses import replace
from pathlib import Path

import numpy as np
import numpy.typing as npt

from talbot.flow.frame import job
from talbot.flow.frame.request import request
from talbot.models.chip import golden_frame
from talbot.models.parameters import ParameterError

Codes = npt.NDArray[np.int16]


def codes_of(name: str = "motorcycle") -> tuple[Codes, npt.NDArray[np.float64]]:
    """Edge codes of a scene without a threshold, and their analog values in LSB, both (rows, cols).

    The values are those of the same exposure without noise, ahead of the converter.
    """
    asked = request(scene=name)
    scene, todo = job.see(asked)
    exposed = job.expose(asked, scene, todo)
    golden = golden_frame(exposed.samples, asked.sensor, replace(asked.frame, threshold=0), exposed.front_end)
    return golden.codes[..., 0], exposed.ideal[..., 0]


def load_codes(path: Path) -> tuple[Codes, npt.NDArray[np.float64]]:
    """The same from an npz file with ``codes`` and ``ideal``. Raises ParameterError."""
    try:
        with np.load(path) as file:
            codes, ideal = file["codes"], file["ideal"]
    except (ValueError, KeyError, TypeError, EOFError, zipfile.BadZipFile):
        raise ParameterError(f"codes = {path}: must be an npz file with codes and ideal") from None
    right = codes.ndim == 2 and codes.size and codes.shape == ideal.shape and codes.dtype.kind == "i"
    if not right or abs(codes.astype(int)).max() > 128:
        raise ParameterError(f"codes = {path}: must hold codes -128..127 and ideal, both (rows, cols)")
    return codes.astype(np.int16), ideal.astype(float)


def thresholded(codes: Codes, threshold: int) -> Codes:
    """What edge mode sends of them: the window comparison makes zeros of magnitudes under the threshold."""
    return np.where(np.abs(codes.astype(np.int16)) < threshold, np.int16(0), codes)


def entropy_bytes(codes: npt.NDArray[np.integer]) -> float:
    """Bytes that an ideal coder of the samples' own frequencies, one by one, would need."""
    _, counts = np.unique(codes, return_counts=True)
    return float(-(counts * np.log2(counts / codes.size)).sum() / 8)
