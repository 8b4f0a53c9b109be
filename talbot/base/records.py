"""Dataclasses from the JSON that ``dataclasses.asdict`` made of them."""

from dataclasses import is_dataclass
from functools import cache
from types import NoneType, UnionType
from typing import Any, Union, get_args, get_origin, get_type_hints

_hints = cache(get_type_hints)


def from_json(kind: Any, value: Any) -> Any:
    """Return ``value``, read from JSON, as ``kind``: a dataclass, or a list, tuple, dict or X | None of such.

    Raises TypeError, KeyError where a field is missing or unknown.
    """
    origin, inner = get_origin(kind), get_args(kind)
    if is_dataclass(kind) and isinstance(kind, type):
        return kind(**{name: from_json(_hints(kind)[name], field) for name, field in value.items()})
    if origin in (list, tuple):
        kinds = inner if origin is tuple and inner[-1] is not ... else inner[:1] * len(value)
        return origin(from_json(one, item) for one, item in zip(kinds, value, strict=True))
    if origin is dict:
        return {key: from_json(inner[1], item) for key, item in value.items()}
    if origin in (Union, UnionType) and value is not None:
        return from_json(next(one for one in inner if one is not NoneType), value)
    return value
