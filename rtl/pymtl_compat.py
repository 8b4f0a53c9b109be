"""Names that PyMTL3 3.1.17 lacks on Python 3.14; `talbot.rtl` restores them before any block imports PyMTL3.

Removed names of `ast`: `Num`, `Str`, `Constant.n`, `visit_Num`. They mean the same as in Python 3.13: a literal
is an instance of `Num` or `Str` by its value; a visitor without `visit_Constant` gets it as `visit_Num` or `visit_Str`.
And `__annotations__` in the namespace of a class (PEP 649), which `pymtl3.bitstruct` reads.
"""

import ast
import importlib.util
import inspect
import sys
from types import ModuleType

BITSTRUCTS = "pymtl3.datatypes.bitstructs"


def _literal(name: str, *types: type) -> type:
    """Return the class ``name`` whose instances are the constants of these ``types``, bool not being a number."""

    def __instancecheck__(cls, node):
        return isinstance(node, ast.Constant) and type(node.value) in types

    def __new__(cls, value=None, **place):
        """Make a constant. place: its line and column, and the value where the caller names it (n, s)."""
        names = [key for key in ("n", "s") if key in place]
        return ast.Constant(value=place.pop(names[0]) if names else value, **place)

    kind = type(f"Of{name}", (type,), {"__instancecheck__": __instancecheck__})
    return kind(name, (), {"__new__": __new__})


Num = _literal("Num", int, float, complex)
Str = _literal("Str", str)


def visit_constant(visitor: ast.NodeVisitor, node: ast.Constant):
    """Visit ``node`` by the visitor's `visit_Num` or `visit_Str`, where it has that one."""
    name = "visit_Num" if isinstance(node, Num) else "visit_Str" if isinstance(node, Str) else ""
    return getattr(visitor, name, visitor.generic_visit)(node)


def restore(module: ModuleType = ast) -> None:
    """Add these names to ``module`` where it lacks them."""
    if hasattr(module, "Num"):
        return
    module.Num, module.Str = Num, Str
    module.Constant.n = property(lambda node: node.value)
    module.NodeVisitor.visit_Constant = visit_constant


def annotated(cls: type) -> type:
    """Return ``cls``, or a copy of it, with `__annotations__` in its namespace."""
    if "__annotations__" in vars(cls):
        return cls
    automatic = "__dict__", "__weakref__", "__annotate__", "__annotate_func__", "__annotations_cache__"
    namespace = {name: value for name, value in vars(cls).items() if name not in automatic}
    namespace |= {"__qualname__": cls.__qualname__, "__annotations__": inspect.get_annotations(cls)}
    return type(cls)(cls.__name__, cls.__bases__, namespace)


class BitstructFinder:
    """Finds PyMTL3's module of bit structs, once, and lets it get each class from `annotated`.

    So only modules that need PyMTL3 import it, which takes a third of a second.
    """

    def find_spec(self, name, path=None, target=None):
        """Return the spec of that module; None for every other."""
        if name != BITSTRUCTS:
            return None
        sys.meta_path.remove(self)
        spec = importlib.util.find_spec(name)
        spec.loader = BitstructLoader(spec.loader)
        return spec


class BitstructLoader:
    """Loads that module by ``loader``, which may load others, too (pytest's does)."""

    def __init__(self, loader):
        self._loader = loader

    def __getattr__(self, name):
        return getattr(self._loader, name)

    def exec_module(self, module):
        """Execute the module and give it the classes that `annotated` returns."""
        self._loader.exec_module(module)
        process = module._process_class
        module._process_class = lambda cls, *words, **options: process(annotated(cls), *words, **options)


if sys.version_info >= (3, 14):
    restore()
    sys.meta_path.insert(0, BitstructFinder())
