"""The Verilog that is proven: as rtl.export writes it, and with a twin's bug in it."""

import re

from models.parameters import ParameterError
from rtl.export import translate

from . import tables


def exported(proof):
    """Module -> the Verilog text that holds it, without comments."""
    texts = {}
    for top in dict.fromkeys(proof.modules.values()):
        texts[top] = re.sub(r"(?m)^\s*//.*\n", "", translate(top, proof.sensor_parameters))
    return {module: texts[top] for module, top in proof.modules.items()}


def wrapper(proof):
    """The wrapper as Yosys reads it: macros, generated tables, then the files."""
    macros = "".join(f"`define {name} {value}\n" for name, value in proof.defines.items())
    made = "".join(tables.TABLES[name](proof) for name in proof.generated)
    return f"{macros}{made}{proof.text}"


def broken(proof, texts, wrapped, label):
    """(texts, wrapped) with the bug of property ``label``. Raises ParameterError unless it has exactly one place."""
    twin = proof.twins[label]
    places = wrapped.count(twin.find) if twin.wrapper else sum(text.count(twin.find) for text in set(texts.values()))
    if places != 1:
        raise ParameterError(f"{proof.name}.twins.{label}.find = {twin.find!r}: must occur once, occurs {places} times")
    if twin.wrapper:
        return texts, wrapped.replace(twin.find, twin.replace)
    return {module: text.replace(twin.find, twin.replace) for module, text in texts.items()}, wrapped
