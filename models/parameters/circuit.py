"""What ngspice says of converter lane and columns in transistors: circuit.json, written by `make analog TABLE=`."""

import json
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from .checks import check_real
from .electrical import ConverterParameters

TABLE = Path(__file__).with_name("circuit.json")
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
class ColumnGains:
    """Of the column amplifiers, over the ideal one, 0.5..1.5 each, common to all columns.

    Attributes
    ----------
    diode : float
        Where each diode has its line.
    sum, later_sum : float
        Of both diodes' charges, in the first tap and in later ones.
    """

    diode: float
    sum: float
    later_sum: float

    def __post_init__(self) -> None:
        check_real("diode", self.diode, 0.5, 1.5)
        check_real("sum", self.sum, 0.5, 1.5)
        check_real("later_sum", self.later_sum, 0.5, 1.5)


@cache
def circuit_columns(table: Path = TABLE) -> ColumnGains:
    """The column amplifiers as the circuit has them.

    Parameters
    ----------
    table : path
        JSON: "columns" has the fields of `ColumnGains`; DRAWN: as the layout has them.

    Returns
    -------
    ColumnGains
        At the typical corner.

    Raises
    ------
    ParameterError
        For a value out of range.
    """
    return ColumnGains(**json.loads(table.read_text())["columns"])
