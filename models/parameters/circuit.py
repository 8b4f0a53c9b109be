"""Results of ngspice for converter lane and columns: circuit.json, written by `make analog TABLE=`."""

import json
from dataclasses import dataclass, replace
from functools import cache
from math import hypot
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from talbot.models.parameters.checks import ParameterError, check_real
from talbot.models.parameters.electrical import ConverterParameters, ElectricalParameters
from talbot.models.parameters.frame import SIGNED

TABLE = Path(__file__).with_name("circuit.json")
DIODE = 127.5  # LSB of a diode whose well is full
# Amplifiers and columns as drawn, written by `make analog-layout TABLE=`
DRAWN = Path(__file__).with_name("circuit_drawn.json")


@cache
def circuit_converter(table: Path = TABLE) -> ConverterParameters:
    """Imperfections of the lane as the circuit has them.

    table: JSON: "parameters" has fields of `ConverterParameters`, in DRAWN the amplifier's alone; "sources" and
    "errors" (LSB) say where each is from, and how far it is from ngspice's. Returns ConverterParameters: of the default
    seed. Raises ParameterError for a value out of range.
    """
    return ConverterParameters(**json.loads(table.read_text(encoding="utf-8"))["parameters"])


def circuit_electrical(electrical: ElectricalParameters, table: Path = TABLE) -> ElectricalParameters:
    """Return a sensor's electrical parameters with noise and mismatch of the column amplifiers.

    electrical: with the read noise of a pixel alone. table: JSON: "diodes" has RMS values in LSB of a diode: a column's
    noise, offsets of columns and of pixels. Returns read noise, offsets of columns and of pixels in electrons. Raises
    ParameterError for a value out of range.
    """
    diodes = json.loads(table.read_text(encoding="utf-8"))["diodes"]
    electrons = {name: electrical.lsb_electrons * rms for name, rms in diodes.items()}
    electrons["read_noise"] = hypot(electrical.read_noise, electrons["read_noise"])
    return replace(electrical, **{name: round(rms, 1) for name, rms in electrons.items()})


@dataclass(frozen=True)
class ColumnCurves:
    """Curves of the column amplifiers, common to all columns.

    Attributes
    ----------
    fills : tuple of float
        Of a full well, rising from 0, to 1 at most.
    a, b : tuple of float
        What reaches the lane of a diode that is so full, as a part of a full well; 0 first, at most 1.5.
    a_other, b_other : tuple of float
        What the diode's lane has where the other one is so full, -0.5..0.5.
    sum_a, sum_b, later_a, later_b : tuple of float
        What a diode that is so full has in the sum of both, in the first tap and in later ones; 0 first, at most 1.5.
    """

    fills: tuple[float, ...]
    a: tuple[float, ...]
    b: tuple[float, ...]
    a_other: tuple[float, ...]
    b_other: tuple[float, ...]
    sum_a: tuple[float, ...]
    sum_b: tuple[float, ...]
    later_a: tuple[float, ...]
    later_b: tuple[float, ...]

    def __post_init__(self) -> None:
        if not (len(self.fills) > 1 and self.fills[0] == 0 and (np.diff(self.fills) > 0).all()):
            raise ParameterError(f"fills = {self.fills}: must rise from 0")
        ranges = {"fills": (0, 1), "a_other": (-0.5, 0.5), "b_other": (-0.5, 0.5)}
        ranges |= dict.fromkeys(("a", "b", "sum_a", "sum_b", "later_a", "later_b"), (0, 1.5))
        for name, (low, high) in ranges.items():
            values = getattr(self, name)
            if len(values) != len(self.fills) or values[0] != 0:
                raise ParameterError(f"{name} = {values}: must be {len(self.fills)} numbers, the first 0")
            for value in values:
                check_real(name, value, low, high)

    def delivered(self, diodes: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        """Return the values of both diodes at the lanes.

        diodes: charges (..., 2), of a full well, 0..1. Returns (..., 2), of a full well: monotone cubics through the
        curves' points, the last one beyond `fills`.
        """
        return self._along(diodes, self.a, self.b) + self._along(diodes[..., ::-1], self.a_other, self.b_other)

    def summed(self, diodes: npt.NDArray[np.float64], later: bool = False) -> npt.NDArray[np.float64]:
        """Return each diode's part of a sum.

        diodes: charges (..., 2), of a full well, 0..1. later: in a tap after the first. Returns (..., 2), of a full
        well, as `delivered` has it.
        """
        return self._along(diodes, *((self.later_a, self.later_b) if later else (self.sum_a, self.sum_b)))

    def _along(self, diodes: npt.NDArray[np.float64], *curves: tuple[float, ...]) -> npt.NDArray[np.float64]:
        """Each diode along its curve."""
        from scipy.interpolate import PchipInterpolator  # 0.4 s, which no command without the circuit's columns needs

        return np.stack([PchipInterpolator(self.fills, curve)(diodes[..., d]) for d, curve in enumerate(curves)], -1)

    def samples(self, diodes: npt.NDArray[np.float64], mode: str) -> npt.NDArray[np.float64]:
        """Return a front end's samples of charges: lanes of each diode, or parts of a sum.

        diodes: (taps, rows, cols, 2) in LSB, DIODE where a well is full. mode: edge, ternary and raw: of each diode;
        image and tof: of sums. Returns (taps, rows, cols, 2) in LSB.
        """
        fills = diodes / DIODE
        if mode in (*SIGNED, "raw"):
            return DIODE * self.delivered(fills)
        return DIODE * np.concatenate([self.summed(fills[:1]), self.summed(fills[1:], later=True)])


@cache
def circuit_columns(table: Path = TABLE) -> ColumnCurves:
    """Return the column amplifiers as the circuit has them.

    table: JSON: "columns" has the fields of `ColumnCurves`; DRAWN: as the layout has them. Returns ColumnCurves: at the
    typical corner. Raises ParameterError for a value out of range.
    """
    written = json.loads(table.read_text(encoding="utf-8"))["columns"]
    values: dict[str, Any] = {
        name: tuple(value) if isinstance(value, list) else value for name, value in written.items()
    }
    return ColumnCurves(**values)
