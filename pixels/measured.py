"""Responses of a tile's types in a file, response.npz: those that `make pixel` solves or a bench measures.

Arrays of the file: ``response`` (types, 2, angles, wavelengths, polarizations), of both diodes across each type's
lines; ``angles`` in rad, ``wavelengths`` in m, ``polarizations`` and ``types`` by name. A bench adds ``table`` (types,
2, angles, across): the responses at angles ``across`` in rad along the lines, too. Any unit that all types share.
"""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from talbot.models.parameters import ParameterError, PixelType
from talbot.models.pixel import TableResponse
from talbot.models.scene.file_form import ARRAY_ERRORS
from talbot.pixels.optics.solve import Floats
from talbot.pixels.optics.table import ACROSS_DEGREES
from talbot.platforms.materials import refractive_index

SUFFIX = ".npz"
ARRAYS = "response", "angles", "wavelengths"


def write_responses(path: Path, names: Sequence[str], responses: Sequence[TableResponse], wavelength: float) -> None:
    """Write measured responses of one wavelength in m, on the same angles each, for light without polarization."""
    table = np.array([response.values for response in responses])
    np.savez_compressed(
        path,
        response=table[:, :, :, 0, None, None],
        types=[*names],
        angles=responses[0].along,
        wavelengths=[wavelength],
        polarizations=["none"],
        across=responses[0].across,
        table=table,
    )


def read_responses(path: str, types: Sequence[PixelType], source: str) -> tuple[PixelType, ...]:
    """Return ``types`` with the responses of a file, of its middle wavelength, the mean over polarizations.

    source: of the responses, before the path. Raises ParameterError.
    """
    try:
        with np.load(path, allow_pickle=False) as file:
            stored = {name: file[name] for name in file.files}
        missing = [name for name in ARRAYS if name not in stored]
        if missing:
            raise ValueError(f"it has no {missing[0]}")
        along, across, values = _tables(stored)
        if len(values) != len(types):
            raise ValueError(f"it has {len(values)} types, the sensor {len(types)}")
        return tuple(
            replace(kind, response=TableResponse(along, across, table, kind.gamma, f"{source}{path}"))
            for kind, table in zip(types, values, strict=True)
        )
    except ARRAY_ERRORS as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else error
        raise ParameterError(
            f"pixel = {path!r}: must be a response.npz of talbot pixel or talbot calibrate ({reason})"
        ) from None


def sine_of_walk(along: Floats, across: Floats, wavelength_um: float) -> Floats:
    """Sine in air (along, across) of the ray across the lines that walks as far across them through the oxide.

    along, across: angles in rad of the rays, as in `TableResponse`.
    """
    index = float(refractive_index("silica", wavelength_um).real)
    tangents = np.tan(along)[:, None], np.tan(across)
    down = 1 / np.sqrt(1 + tangents[0] ** 2 + tangents[1] ** 2)
    kx, ky = (tangent * down for tangent in tangents)
    walk = kx / np.sqrt(index**2 - kx**2 - ky**2)
    return index * walk / np.sqrt(1 + walk**2)


def _tables(stored: dict[str, np.ndarray]) -> tuple[Floats, Floats, Floats]:
    """Angles along and across, and values (types, 2, along, across)."""
    along = np.asarray(stored["angles"], np.float64)
    if "table" in stored:
        return along, np.asarray(stored["across"], np.float64), np.asarray(stored["table"], np.float64)
    response = np.asarray(stored["response"], np.float64)
    if response.ndim != 5 or response.shape[2] != along.size:
        raise ValueError(f"its response has the shape {response.shape}, that of types is (types, 2, angles, ...)")
    middle = response.shape[3] // 2
    across = np.deg2rad(ACROSS_DEGREES)
    sines = sine_of_walk(along, across, 1e6 * float(stored["wavelengths"][middle]))
    at = np.clip(sines, np.sin(along[0]), np.sin(along[-1]))
    from scipy.interpolate import CubicSpline  # imported where it is needed: it is slow

    curves = response[:, :, :, middle].mean(-1)
    return along, across, np.maximum(CubicSpline(np.sin(along), curves, axis=2)(at), 0)
