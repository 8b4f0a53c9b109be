"""What ngspice says of the converter lane in transistors: circuit.json, written by `make analog TABLE=`."""

import json
from functools import cache
from pathlib import Path

from .electrical import ConverterParameters

TABLE = Path(__file__).with_name("circuit.json")


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
