"""Values kept by content: computed once, again where anything that decides them changes or the file is damaged."""

import functools
import importlib.util
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path

import numpy as np
import pytest

from talbot.base import kept as module
from talbot.base.kept import Unnamed, afresh, content, kept

CALLS = []


@dataclass(frozen=True)
class Lens:
    focus: float
    sums: np.ndarray


def total(lens, path=None):
    CALLS.append(lens.focus)
    return {"sum": lens.sums.sum() * lens.focus}


def zeros(size):
    return np.zeros(size, np.uint8)


@pytest.fixture(autouse=True)
def store(tmp_path, monkeypatch):
    monkeypatch.setattr(module, "STORE", tmp_path)
    CALLS.clear()
    return tmp_path


def test_a_value_is_computed_once_for_the_same_content(tmp_path):
    file = tmp_path / "file"
    file.write_text("a")
    for lens in (Lens(2.0, np.arange(3)), Lens(2.0, np.arange(3)), Lens(2.5, np.arange(3)), Lens(2.0, np.arange(3.0))):
        assert kept("sums", total, lens, file) == {"sum": 3 * lens.focus}
    assert CALLS == [2.0, 2.5, 2.0]
    file.write_text("b")
    kept("sums", total, Lens(2.0, np.arange(3)), file)
    assert len(CALLS) == 4


def test_a_function_of_a_script_has_no_content(tmp_path):
    """Its text may change under the same name; a package's is named by its module's code."""
    script = tmp_path / "script.py"
    script.write_text("def response(angle):\n    return angle\n")
    spec = importlib.util.spec_from_file_location("script", script)
    mine = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(mine)
    for value in (mine.response, functools.partial(mine.response, 1)):
        with pytest.raises(Unnamed):
            content(value)
    content((np.ma.MaskedArray, functools.partial(total, 1), Path, OSError))
    for _ in range(2):
        kept("sums", total, Lens(2.0, np.arange(3)), mine.response)
    assert len(CALLS) == 2


def local(size):
    CALLS.append(size)
    return lambda: size


def test_a_value_that_cannot_be_pickled_is_computed_each_time(store):
    assert [kept("local", local, 3)() for _ in range(2)] == [3, 3]
    assert len(CALLS) == 2 and not (store / "local").exists()


def test_what_an_object_computes_of_itself_is_no_content():
    class Plain:
        def __init__(self):
            self.size = 3

        @functools.cached_property
        def area(self):
            return self.size**2

    first = Plain()
    before = content(first)
    assert first.area == 9 and content(first) == before
    first.size = 4
    assert content(first) != before


def test_a_value_whose_time_is_measured_is_computed_each_time():
    for _ in range(2):
        with afresh():
            kept("sums", total, Lens(2.0, np.arange(3)))
    assert len(CALLS) == 2


@pytest.mark.parametrize(
    "damage", [lambda data: data[:-1], lambda data: data[:40] + bytes([data[40] ^ 1]) + data[41:], lambda data: b""]
)
def test_a_damaged_file_is_computed_again(store, damage):
    first = kept("sums", total, Lens(2.0, np.arange(3)))
    (file,) = (store / "sums").iterdir()
    file.write_bytes(damage(file.read_bytes()))
    for _ in range(2):
        assert kept("sums", total, Lens(2.0, np.arange(3))) == first
    assert len(CALLS) == 2


def test_a_store_that_cannot_be_written_changes_no_value(store):
    (store / "sums").write_text("a file")
    assert kept("sums", total, Lens(2.0, np.arange(3))) == {"sum": 6.0}


def test_what_was_used_least_recently_goes_first(store):
    for size in (1000, 1001, 1002):
        kept("zeros", zeros, size, most=2500)
    sizes = sorted(len(file.read_bytes()) // 100 for file in (store / "zeros").iterdir())
    assert len(sizes) == 2
    kept("zeros", zeros, 1, most=1)
    assert len(list((store / "zeros").iterdir())) == 1


def test_processes_that_keep_the_same_value_at_once(store):
    with get_context("fork").Pool(4) as pool:
        found = pool.starmap(kept, [("zeros", zeros, 100_000)] * 8)
    assert all(array.size == 100_000 for array in found)
    assert len(list((store / "zeros").iterdir())) == 1


class Holder:
    def __init__(self, value):
        self.value = value

    def method(self):
        return self.value


def holding(value):
    return lambda: value


def test_content_is_what_an_object_holds():
    alike = [
        lambda x: x,
        Holder,
        lambda x: Holder(x).method,
        holding,
        lambda x: functools.partial(zeros, x),
        lambda x: {"a": [x, (x,)]},
        lambda x: functools.lru_cache(functools.partial(zeros, x)),
    ]
    for make in alike:
        values = [np.array([1, 2]), np.array([1, 2]), np.array([1, 3]), np.array([[1, 2]])]
        a, b, c, d = (content(make(value))[0] for value in values)
        assert a == b and len({a, c, d}) == 3


def test_the_code_of_what_an_object_is_made_of_counts():
    from talbot.models.scene import Sampling, load

    scene = load("motorcycle", Sampling(rows=24, cols=24))
    assert {"talbot.models.scene.scene", "talbot.models.scene.views"} <= content(scene)[1]


@pytest.mark.parametrize("thing", [object(), open, {Path("x"): iter("x")}])
def test_what_has_no_content_is_computed_each_time(store, thing):
    with pytest.raises(Unnamed):
        content(thing)
    holds_itself: list[object] = []
    holds_itself.append(holds_itself)
    with pytest.raises(Unnamed, match="holds itself"):
        content(holds_itself)
