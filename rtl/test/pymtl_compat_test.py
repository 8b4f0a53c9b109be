"""The literals of PyMTL3's `ast` on Python 3.14, tested on every Python: on a copy of what the module has there."""

import ast
import subprocess
import sys
from importlib.metadata import version
from types import SimpleNamespace

import pytest

from talbot.rtl.pymtl_compat import Num, Str, annotated, restore, visit_constant


def literal(text):
    return ast.parse(text, mode="eval").body


@pytest.mark.parametrize(
    "text, number, string",
    [("3", True, False), ("2.5", True, False), ("1j", True, False), ("'a'", False, True)]
    + [(text, False, False) for text in ("True", "None", "b'a'", "...", "x")],
)
def test_a_constant_is_of_the_kind_of_its_value(text, number, string):
    assert (isinstance(literal(text), Num), isinstance(literal(text), Str)) == (number, string)


def test_a_number_is_made_as_pymtl3_makes_it():
    node = Num(n=3, lineno=2, col_offset=5)
    assert (type(node), node.value, node.lineno, node.col_offset) == (ast.Constant, 3, 2, 5)
    assert Str("a").value == "a"


class Visitor(ast.NodeVisitor):
    visit_Constant = visit_constant

    def visit_Num(self, node):
        return f"number {node.value}"


def test_a_visitor_gets_numbers_by_its_own_method():
    assert Visitor().visit(literal("7")) == "number 7"
    assert Visitor().visit(literal("'a'")) is None and Visitor().visit(literal("True")) is None


def test_only_what_lacks_the_names_gets_them():
    bare = SimpleNamespace(Constant=type("Constant", (), {"value": 4}), NodeVisitor=type("NodeVisitor", (), {}))
    restore(bare)
    assert (bare.Num, bare.Str, bare.Constant().n) == (Num, Str, 4)
    assert bare.NodeVisitor.visit_Constant is visit_constant
    whole = SimpleNamespace(Num=1)
    restore(whole)
    assert vars(whole) == {"Num": 1}


class Annotated:
    """Its text."""

    high: int
    low: int = 3

    def sum(self):
        return self.high + self.low


def test_a_class_gets_its_annotations_into_its_namespace(monkeypatch):
    namespace = {name: value for name, value in vars(Annotated).items() if not name.startswith(("__ann", "__dict"))}
    namespace.pop("__weakref__")
    monkeypatch.setattr("inspect.get_annotations", lambda cls: {"high": int, "low": int})
    lacking = type("Annotated", (), namespace)
    copy = annotated(lacking)
    assert vars(copy)["__annotations__"] == {"high": int, "low": int}
    assert (copy.__name__, copy.__module__, copy.__doc__, copy.low) == ("Annotated", __name__, "Its text.", 3)
    assert annotated(copy) is copy


def test_pymtl3_gets_the_annotations_when_it_is_imported():
    program = """
import sys, talbot.rtl.pymtl_compat as compat
sys.meta_path[:] = [compat.BitstructFinder(), *(f for f in sys.meta_path if type(f) is not compat.BitstructFinder)]
seen = []
annotated, compat.annotated = compat.annotated, lambda cls: seen.append(cls.__name__) or annotated(cls)
from pymtl3 import Bits1, bitstruct
@bitstruct
class Pair:
    high: Bits1
    low: Bits1
print(Pair.nbits, seen, any(type(f) is compat.BitstructFinder for f in sys.meta_path))
"""
    run = subprocess.run([sys.executable, "-W", "ignore", "-c", program], capture_output=True, text=True)
    assert run.stdout == "2 ['Pair'] False\n", run.stderr


def test_pymtl3_is_the_release_that_needs_it():
    assert version("pymtl3") == "3.1.17", (
        "does this one run on Python 3.14 without rtl/pymtl_compat.py? Then delete that"
    )
