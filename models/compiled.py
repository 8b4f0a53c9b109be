"""Numba's compiler with a cache that heals: half a file of it, which no program can read, counts as none.

Files of a full disk or of a machine that lost power are such; Numba itself ends with what unpickling raises.
"""

from numba import njit, vectorize
from numba.core import caching

__all__ = ["njit", "vectorize"]


class _HealingFile(caching.IndexDataCacheFile):
    def load(self, key: object) -> object:
        """What is kept under ``key``; where that is damaged, None, and the index is written again."""
        try:
            return super().load(key)
        except Exception:  # unpickling raises nearly anything
            self.flush()
            return None


caching.IndexDataCacheFile = _HealingFile
