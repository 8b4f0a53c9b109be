"""The Verilog under proof: the export of rtl.export, and the same with a twin's bug."""

import re
from functools import cache

from talbot.models.parameters import ParameterError, SensorParameters
from talbot.rtl.export import translate
from talbot.verif.formal import tables
from talbot.verif.formal.proof import Proof


def without_comments(verilog: str) -> str:
    """Return the Verilog without its lines of comments."""
    return re.sub(r"(?m)^\s*//.*\n", "", verilog)


@cache  # several proofs are of one top, and every mutant asks for all
def _exported(top: str, sensor: SensorParameters) -> str:
    return without_comments(translate(top, sensor))


def exported(proof: Proof) -> dict[str, str]:
    """Return module -> the Verilog that holds it, without comments."""
    return {module: _exported(top, proof.sensor_parameters) for module, top in proof.modules.items()}


def wrapper(proof: Proof) -> str:
    """Return the wrapper as Yosys reads it: macros, generated tables, then the files."""
    macros = "".join(f"`define {name} {value}\n" for name, value in proof.defines.items())
    generated = "".join(tables.TABLES[name](proof) for name in proof.generated)
    return f"{macros}{generated}{proof.text}"


def broken(proof: Proof, texts: dict[str, str], wrapped: str, label: str) -> tuple[dict[str, str], str]:
    """Return (texts, wrapped) with the bug of property ``label``. Raises ParameterError unless it has one place."""
    twin = proof.twins[label]
    places = wrapped.count(twin.find) if twin.wrapper else sum(text.count(twin.find) for text in set(texts.values()))
    if places != 1:
        raise ParameterError(f"{proof.name}.twins.{label}.find = {twin.find!r}: must occur once, occurs {places} times")
    if twin.wrapper:
        return texts, wrapped.replace(twin.find, twin.replace)
    return {module: text.replace(twin.find, twin.replace) for module, text in texts.items()}, wrapped
