"""Where each default comes from: kept with the field, shown in the report."""

from dataclasses import field, fields
from typing import Any


def sourced(default: Any, source: str) -> Any:
    """Dataclass field with a default and its source.

    Parameters
    ----------
    default : any
        The default.
    source : str
        Bibliography key and place, 'our choice', or 'assumed'.

    Returns
    -------
    any
        As of `dataclasses.field`.
    """
    return field(default=default, metadata={"source": source})


def sources(parameters: Any) -> list[tuple[str, Any, str]]:
    """Values of a parameter object and the sources of their defaults, of the fields that have one.

    Parameters
    ----------
    parameters : dataclass
        Instance of a class of which some fields are `sourced`.

    Returns
    -------
    list of (str, any, str)
        Name, value, and source; 'set' where the value is not the default.
    """
    rows = []
    for item in (item for item in fields(parameters) if "source" in item.metadata):
        value = getattr(parameters, item.name)
        rows.append((item.name, value, item.metadata["source"] if value == item.default else "set"))
    return rows
