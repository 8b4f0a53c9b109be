"""Dataclasses through JSON and back are equal, nested ones too."""

import json
from dataclasses import asdict, dataclass, field

import pytest

from talbot.base.records import from_json


@dataclass
class Inner:
    number: int
    pair: tuple[int, str]


@dataclass
class Outer:
    first: Inner
    maybe: Inner | None = None
    others: list[Inner] = field(default_factory=list)
    names: tuple[str, ...] = ()
    table: dict[str, Inner] = field(default_factory=dict)


def test_round_trip():
    one, two = Inner(1, (2, "a")), Inner(3, (4, "b"))
    for outer in (Outer(one), Outer(one, two, [one, two], ("x", "y"), {"k": two})):
        assert from_json(Outer, json.loads(json.dumps(outer, default=asdict))) == outer
    assert from_json(list[Inner], [{"number": 1, "pair": [2, "a"]}]) == [one]
    assert from_json(dict[str, int], {"a": 1}) == {"a": 1}


def test_an_unknown_field_is_refused():
    with pytest.raises(KeyError):
        from_json(Inner, {"number": 1, "other": 2})


def test_what_is_no_dataclass_is_refused():
    with pytest.raises(TypeError):
        json.dumps({"a": object()}, default=asdict)
