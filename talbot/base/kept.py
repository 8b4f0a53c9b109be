"""Values that take long to compute, kept on disk under the content of all that decides them.

`kept` names a value by its function's code (`base.sources`), the content of the arguments and the code of their
classes and functions. A file that is damaged counts as none; a store has a largest size, and what was used least
recently goes first. Programs and folders are kept by `base.cache`.
"""

import contextlib
import dataclasses
import functools
import hashlib
import os
import pickle
import sys
import sysconfig
import types
from collections.abc import Callable, Iterator
from contextvars import ContextVar
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from talbot.base.cache import digest
from talbot.base.files import write
from talbot.base.paths import BUILD
from talbot.base.sources import code
from talbot.models.sealed import sealed, unsealed

T = TypeVar("T")
STORE = BUILD / "kept"
MOST = 256 << 20  # bytes of a store
_AFRESH = ContextVar("afresh", default=False)
PLAIN = (type(None), bool, int, float, complex, str, bytes, slice, range, np.generic, np.dtype)


class Unnamed(TypeError):
    """The content of an object cannot be determined."""


def kept(store: str, compute: Callable[..., T], *arguments: object, most: int = MOST) -> T:
    """Return ``compute(*arguments)``, now or earlier; computed where an argument's content cannot be determined.

    store: name of the folder of such values. compute: a function of a module; a value that cannot be pickled is
    computed each time. most: size of the store in bytes.
    """
    if _AFRESH.get():
        return compute(*arguments)
    try:
        file = STORE / store / _key(compute, arguments)
    except (Unnamed, ValueError):  # ValueError: an empty cell of a closure
        return compute(*arguments)
    with contextlib.suppress(OSError):
        if (data := unsealed(file.read_bytes())) is not None:
            with contextlib.suppress(OSError):  # of another user
                os.utime(file)
            return pickle.loads(data)
    value = compute(*arguments)
    try:
        pickled = pickle.dumps(value, pickle.HIGHEST_PROTOCOL)
    except (pickle.PicklingError, AttributeError, TypeError):  # holds a function within a function
        return value
    with contextlib.suppress(OSError):  # a full disk, a folder of another user: then it is computed again
        write(file, sealed(pickled))
        _bound(file.parent, most)
    return value


@contextlib.contextmanager
def afresh() -> Iterator[None]:
    """Compute all values in this context, whatever is kept: where the time that they take is measured."""
    before = _AFRESH.set(True)
    try:
        yield
    finally:
        _AFRESH.reset(before)


def content(value: object) -> tuple[str, set[str]]:
    """Return the digest of an object's content, and the package's modules whose code it consists of. Raises Unnamed.

    Objects are their class and attributes; of a dataclass, its fields; a function is its name and what it holds.
    """
    found, modules = hashlib.sha256(), set[str]()
    for part in _parts(value, modules, ()):
        found.update(part)
    return found.hexdigest(), modules


def _key(compute: Callable[..., object], arguments: tuple[object, ...]) -> str:
    text, modules = content((compute, arguments))
    return digest(code(*sorted(modules)), text, sys.version, np.__version__)


def _parts(value: Any, modules: set[str], above: tuple[int, ...]) -> Iterator[bytes | memoryview]:
    """What identifies ``value``, piece by piece; ``modules`` gets those of its code. above: objects that hold it."""
    if isinstance(value, PLAIN):
        yield f"{type(value).__name__} {value!r};".encode()
        return
    if id(value) in above:
        raise Unnamed(f"{type(value).__name__}: holds itself")
    above = (*above, id(value))
    if isinstance(value, np.ndarray) and not value.dtype.hasobject:
        yield f"array {value.dtype.str} {value.shape};".encode()
        yield np.ascontiguousarray(value).reshape(-1).view(np.uint8).data
        return
    if isinstance(value, Path):
        yield f"file {digest(value) if value.exists() else value};".encode()
        return
    if isinstance(value, functools.partial):
        held: Any = value.func, value.args, value.keywords
    elif isinstance(value, types.MethodType):
        held = value.__func__, value.__self__
    elif isinstance(value, tuple | list):
        held = value
    elif isinstance(value, dict):
        held = value.items()
    elif (wrapped := getattr(value, "__wrapped__", None)) is not None:  # functools.cache
        held = (wrapped,)
    elif isinstance(value, types.FunctionType):
        held = value.__defaults__, value.__kwdefaults__, [cell.cell_contents for cell in value.__closure__ or ()]
    elif isinstance(value, type):
        held = ()
    elif dataclasses.is_dataclass(value):
        held = [(field.name, getattr(value, field.name)) for field in dataclasses.fields(value)]
    elif hasattr(value, "__dict__"):
        computed = functools.cached_property  # of the other attributes
        kind = type(value)
        held = [(name, part) for name, part in vars(value).items() if not isinstance(getattr(kind, name, 0), computed)]
    else:
        raise Unnamed(type(value).__name__)
    named = value if isinstance(value, types.FunctionType | type) else type(value)
    if named.__module__.startswith("talbot."):
        modules.add(named.__module__)
    elif not _installed(named.__module__):
        raise Unnamed(f"{named.__qualname__}: its code is of no package")
    yield f"{named.__module__}.{named.__qualname__} {len(held)}(".encode()
    for item in held:
        yield from _parts(item, modules, above)
    yield b")"


@functools.cache
def _installed(module: str) -> bool:
    """Return whether a module is Python's or of an installed package, whose code stays as it is."""
    file = getattr(sys.modules.get(module), "__file__", None)
    if file is None:
        return module in sys.builtin_module_names
    folders = {sysconfig.get_path(name) for name in ("stdlib", "platstdlib", "purelib", "platlib")}
    return module != "__main__" and any(Path(file).is_relative_to(folder) for folder in folders)


def _bound(folder: Path, most: int) -> None:
    """Remove the least recently used files until the files of ``folder`` have ``most`` bytes."""
    states = []
    for file in folder.iterdir():
        with contextlib.suppress(OSError):
            state = file.stat()
            states.append((state.st_mtime_ns, state.st_size, file))
    left = sum(size for _, size, _ in states)
    for _, size, file in sorted(states)[:-1]:
        if left > most and file.is_file():
            with contextlib.suppress(OSError):
                file.unlink()
            left -= size
