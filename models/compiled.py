"""Numba's compiler: imported when the first of its functions is called, with a cache that heals.

A program whose results are kept (`base.kept`) then starts without Numba, a third of its time. A damaged file of Numba's
cache counts as none: half a file of a full disk or of a machine that lost power, on which Numba itself ends with what
unpickling raises, and another byte in it, which would be run as a program.
"""

import pickle
from collections.abc import Callable
from functools import cache, cached_property, update_wrapper
from typing import Any

from talbot.models.sealed import sealed, unsealed

__all__ = ["njit", "vectorize"]


class Compiled:
    """A function that Numba compiles when it is first called, or when one that calls it is compiled.

    function: what is compiled.
    decorator: of Numba.
    *arguments, **options: of the decorator.
    """

    def __init__(self, function: Callable[..., Any], decorator: str, *arguments: Any, **options: Any) -> None:
        self._decorated = function, decorator, arguments, options
        update_wrapper(self, function)

    @cached_property
    def compiled(self) -> Any:
        """Numba's dispatcher."""
        function, decorator, arguments, options = self._decorated
        return getattr(_numba(), decorator)(*arguments, **options)(function)

    def __call__(self, *arguments: Any, **named: Any) -> Any:
        """Return the function's value."""
        return self.compiled(*arguments, **named)

    def __reduce__(self) -> str:
        return self.__qualname__  # type: ignore[attr-defined]  # of the function

    @property
    def _numba_type_(self) -> Any:
        """The Numba type of this in functions that call it."""
        return self.compiled._numba_type_


def njit(**options: Any) -> Callable[[Callable[..., Any]], Any]:
    """Compile a function as `numba.njit` does.

    **options: of `numba.njit`. Returns the decorator.
    """
    return lambda function: Compiled(function, "njit", **options)


def vectorize(signatures: list[str], **options: Any) -> Callable[[Callable[..., Any]], Any]:
    """Compile a function of numbers for arrays as `numba.vectorize` does.

    signatures: types. **options: of `numba.vectorize`. Returns the decorator.
    """
    return lambda function: Compiled(function, "vectorize", signatures, **options)


@cache
def _numba() -> Any:
    import numba
    from numba.core import caching

    class HealingFile(caching.IndexDataCacheFile):
        def load(self, key: object) -> object:
            """Return the entry of ``key``; None where it is damaged or another's, and the index is written again.

            Two processes may give files for two signatures one name.
            """
            try:
                entry = super().load(key)
                if entry is None:
                    return None
                of, data = entry
                if of != key:
                    raise KeyError(key)
                return data
            except Exception:  # unpickling raises nearly anything
                self.flush()
                return None

        def save(self, key: object, data: object) -> None:
            """Save an entry with its key."""
            super().save(key, (key, data))

        def _dump(self, obj: Any) -> bytes:
            return sealed(super()._dump(obj))  # the index, too, which Numba reads as a pickle

        def _load_data(self, name: str) -> object:
            with open(self._data_path(name), "rb") as file:
                data = unsealed(file.read())
            if data is None:
                raise ValueError(name)
            return pickle.loads(data)

    caching.IndexDataCacheFile = HealingFile
    return numba
