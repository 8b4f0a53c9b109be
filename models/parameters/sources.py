"""The source of each default: stored with the field, shown in the report."""

from dataclasses import field, fields
from typing import Any, NamedTuple


class Sourced(NamedTuple):
    """A parameter's value and where it comes from.

    Attributes
    ----------
    name : str
        Of the field.
    value : any
        Its value.
    unit : str
        Of the value, '' of a pure number.
    source : str
        Of the default; 'set' where the value is another.
    """

    name: str
    value: Any
    unit: str
    source: str


def sourced(default: Any, source: str, unit: str = "") -> Any:
    """Dataclass field with a default and its source.

    default: the default. source: bibliography key and place, 'our choice', or 'assumed'. unit: of the value, '' of a
    pure number. Returns any: as of `dataclasses.field`.
    """
    return field(default=default, metadata={"source": source, "unit": unit})


def sources(parameters: Any) -> list[Sourced]:
    """Values of a parameter object and the sources of their defaults, of the fields that have one.

    parameters: instance of a class of which some fields are `sourced`. Returns list of Sourced: in the order of the
    fields.
    """
    rows = []
    for item in (item for item in fields(parameters) if "source" in item.metadata):
        value = getattr(parameters, item.name)
        source = item.metadata["source"] if value == item.default else "set"
        rows.append(Sourced(item.name, value, item.metadata["unit"], source))
    return rows
