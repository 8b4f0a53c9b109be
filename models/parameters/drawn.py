"""The drawn pixel as computed: its lines and response by `make pixel-layout TABLE= CURVES=`, its circuit by
`make pixel-circuit TABLE=`.
"""

import json
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np
import numpy.typing as npt

from talbot.models.parameters.array import ArrayParameters
from talbot.models.parameters.checks import check_real
from talbot.models.parameters.circuit import TABLE as CIRCUIT
from talbot.models.parameters.circuit import circuit_electrical
from talbot.models.parameters.electrical import ElectricalParameters

LINES = Path(__file__).with_name("pixel_lines.json")
PIXEL = Path(__file__).with_name("pixel.json")
CURVES = Path(__file__).with_name("pixel_curves.json")
RAISED = Path(__file__).with_name("pixel_curves_raised.json")  # with SKY130's second table of heights


@dataclass(frozen=True)
class LineParameters:
    """A pixel's part of the array's lines.

    Attributes
    ----------
    row_ohm, column_ohm : float
        Of the metal along the pixel, 1e-3..1e5 ohm.
    row_farad, column_farad : float
        Of the metal to all else, without gates and junctions, 1e-18..1e-11 F.
    """

    row_ohm: float
    row_farad: float
    column_ohm: float
    column_farad: float

    def __post_init__(self) -> None:
        check_real("row_ohm", self.row_ohm, 1e-3, 1e5)
        check_real("row_farad", self.row_farad, 1e-18, 1e-11)
        check_real("column_ohm", self.column_ohm, 1e-3, 1e5)
        check_real("column_farad", self.column_farad, 1e-18, 1e-11)


@cache
def drawn_lines(pitch_um: float = ArrayParameters().pitch_um, table: Path = LINES) -> LineParameters:
    """Row and column lines as extracted from drawn arrays.

    pitch_um: of the pixels, in the range of the table. table: JSON: "pitches_um", ascending, and at each of them
    "parameters" with the fields of `LineParameters` and "lines", each at the corners of wires. Returns the larger of
    the two row lines and of the two column lines, typical, linear between two pitches. Raises ParameterError for a
    value out of range.
    """
    written = json.loads(table.read_text(encoding="utf-8"))
    pitches = written["pitches_um"]
    check_real("pitch_um", pitch_um, pitches[0], pitches[-1])
    values = {name: [one[name] for one in written["parameters"]] for name in written["parameters"][0]}
    return LineParameters(**{name: float(np.interp(pitch_um, pitches, along)) for name, along in values.items()})


def drawn_electrical(electrical: ElectricalParameters, table: Path = PIXEL) -> ElectricalParameters:
    """Return a sensor's electrical parameters with those of the drawn pixel's circuit and its column.

    electrical: of which amplifiers, light and time of flight stay. table: JSON: "parameters" has fields of
    `ElectricalParameters`; "sources" says where each is from. Full well, swing, dark current, gain FPN, noise and
    offsets of the result are those that ngspice has. Raises ParameterError for a value out of range.
    """
    return circuit_electrical(replace(electrical, **json.loads(table.read_text(encoding="utf-8"))["parameters"]))


def drawn_sources(electrical: ElectricalParameters, table: Path = PIXEL) -> dict[str, str]:
    """Return the sources of the parameters of a sensor with the drawn pixel.

    electrical: of any sensor. table: as of `drawn_electrical`. Returns source by name; none for other pixels.
    """
    if electrical != drawn_electrical(electrical, table):
        return {}
    pixel, column = (json.loads(file.read_text(encoding="utf-8")) for file in (table, CIRCUIT))
    of_column = {name: f"{column['command']}: {column['sources'][name]}" for name in column["diodes"]}
    both = f"{pixel['sources']['read_noise']}; {of_column['read_noise']}"
    return pixel["sources"] | of_column | {"read_noise": both}


@cache
def drawn_curves(table: Path = CURVES) -> Mapping[tuple[float, float, float], npt.NDArray[np.float64]]:
    """Angular responses of drawn pixels along their own gratings, light without polarization.

    table: JSON: "curves" has the beta, gamma_deg, alpha, sines and shares of each type. Returns (beta, gamma in
    degrees, alpha in rad), sine of the angle in air, ascending; share of the light on the pixel that reaches each
    diode. Gamma is 0 or more: of -gamma they are those of gamma.
    """
    curves = json.loads(table.read_text(encoding="utf-8"))["curves"]
    return {(c["beta"], c["gamma_deg"], c["alpha"]): np.array([c["sines"], *c["shares"]]) for c in curves}
