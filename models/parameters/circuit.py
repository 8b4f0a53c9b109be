"""What ngspice says of converter lane and columns in transistors: circuit.json, written by `make analog TABLE=`."""

import json
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from .checks import ParameterError, check_real
from .electrical import ConverterParameters

TABLE = Path(__file__).with_name("circuit.json")
OFFSETS = 0xC01  # of the seed of columns' offsets
DIODE = 127.5  # LSB of a diode whose well is full
DRAWN = Path(__file__).with_name("circuit_drawn.json")  # columns as drawn, written by `make analog-layout TABLE=`


@cache
def circuit_converter(table: Path = TABLE) -> ConverterParameters:
    """Imperfections of the lane as the circuit has them.

    Parameters
    ----------
    table : path
        JSON: "parameters" has fields of `ConverterParameters`; "sources" and "errors" (LSB) say where each is from, and
        how far it is from ngspice's.

    Returns
    -------
    ConverterParameters
        Of the default seed.

    Raises
    ------
    ParameterError
        For a value out of range.
    """
    return ConverterParameters(**json.loads(table.read_text())["parameters"])


@dataclass(frozen=True)
class ColumnCurves:
    """Of the column amplifiers, common to all columns.

    Attributes
    ----------
    fills : tuple of float
        Of a full well, rising from 0, to 1 at most.
    a, b : tuple of float
        What reaches the lane of a diode that is so full, as a part of a full well; 0 first, at most 1.5.
    a_other, b_other : tuple of float
        What the diode's lane has where the other one is so full, -0.5..0.5.
    sum, later_sum : float
        More of both diodes' sum than their lanes have, in the first tap and in later ones, 0.5..1.5.
    spread : float
        Rms over columns of what a diode's lane has without light, in LSB of a diode, 0..16.
    """

    fills: tuple[float, ...]
    a: tuple[float, ...]
    b: tuple[float, ...]
    a_other: tuple[float, ...]
    b_other: tuple[float, ...]
    sum: float
    later_sum: float
    spread: float = 0.0

    def __post_init__(self) -> None:
        if not (len(self.fills) > 1 and self.fills[0] == 0 and (np.diff(self.fills) > 0).all()):
            raise ParameterError(f"fills = {self.fills}: must rise from 0")
        ranges = {"fills": (0, 1), "a": (0, 1.5), "b": (0, 1.5), "a_other": (-0.5, 0.5), "b_other": (-0.5, 0.5)}
        for name, (low, high) in ranges.items():
            values = getattr(self, name)
            if len(values) != len(self.fills) or values[0] != 0:
                raise ParameterError(f"{name} = {values}: must be {len(self.fills)} numbers, the first 0")
            for value in values:
                check_real(name, value, low, high)
        check_real("sum", self.sum, 0.5, 1.5)
        check_real("later_sum", self.later_sum, 0.5, 1.5)
        check_real("spread", self.spread, 0, 16)

    def delivered(self, diodes: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        """What the lanes have of both diodes.

        Parameters
        ----------
        diodes : ndarray
            Charges (..., 2), of a full well, 0..1.

        Returns
        -------
        ndarray
            (..., 2), of a full well: monotone cubics through the curves' points, the last one beyond `fills`.
        """
        from scipy.interpolate import PchipInterpolator  # 0.4 s, which no command without the circuit's columns needs

        own, other = diodes, diodes[..., ::-1]
        parts = [
            PchipInterpolator(self.fills, curve)(filled[..., d])
            for curves, filled in (((self.a, self.b), own), ((self.a_other, self.b_other), other))
            for d, curve in enumerate(curves)
        ]
        return np.stack([parts[0] + parts[2], parts[1] + parts[3]], -1)

    def samples(self, diodes: npt.NDArray[np.float64], mode: str) -> npt.NDArray[np.float64]:
        """What a front end has of charges, without `spread`: lanes of each diode, or parts of a sum.

        Parameters
        ----------
        diodes : ndarray
            (taps, rows, cols, 2) in LSB, DIODE where a well is full.
        mode : str
            edge and raw: of each diode; image and tof: of sums.

        Returns
        -------
        ndarray
            (taps, rows, cols, 2) in LSB.
        """
        found = DIODE * self.delivered(diodes / DIODE)
        if mode in ("edge", "raw"):
            return found
        sums = self.sum, *[self.later_sum] * (len(diodes) - 1)
        return found * np.reshape(sums, (-1, 1, 1, 1))

    def offsets(self, cols: int, seed: int) -> npt.NDArray[np.float64]:
        """Offsets of columns that are not alike: normal, the same in every frame.

        Parameters
        ----------
        cols : int
            How many.
        seed : int
            Of the chip, at least 0.

        Returns
        -------
        ndarray
            (cols, 2), of both diodes' lanes, in LSB of a diode.
        """
        return self.spread * np.random.default_rng((seed, OFFSETS)).standard_normal((cols, 2))


@cache
def circuit_columns(table: Path = TABLE) -> ColumnCurves:
    """The column amplifiers as the circuit has them.

    Parameters
    ----------
    table : path
        JSON: "columns" has the fields of `ColumnCurves`; DRAWN: as the layout has them.

    Returns
    -------
    ColumnCurves
        At the typical corner.

    Raises
    ------
    ParameterError
        For a value out of range.
    """
    written = json.loads(table.read_text())["columns"]
    given: dict[str, Any] = {name: tuple(one) if isinstance(one, list) else one for name, one in written.items()}
    return ColumnCurves(**given)
