"""A table over input slews and output loads."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt


@dataclass(frozen=True)
class Table:
    """Quantities by name, each (slews, loads) in SI units."""

    slews: tuple[float, ...]
    loads: tuple[float, ...]
    values: dict[str, npt.NDArray[np.float64]]

    def at(self, name: str, slew: float, load: float) -> float:
        """Value by bilinear interpolation, and extrapolation outside, as timing analysis does it."""
        return bilinear(self.slews, self.loads, self.values[name], slew, load)


def bilinear(rows: npt.ArrayLike, columns: npt.ArrayLike, values: npt.ArrayLike, row: float, column: float) -> float:
    """Value at (row, column) of ``values`` (rows, columns) with axes that rise; linear beyond the ends."""
    rows, columns, values = (np.asarray(a, dtype=float) for a in (rows, columns, values))
    i = int(np.clip(np.searchsorted(rows, row) - 1, 0, len(rows) - 2))
    j = int(np.clip(np.searchsorted(columns, column) - 1, 0, len(columns) - 2))
    s = (row - rows[i]) / (rows[i + 1] - rows[i])
    t = (column - columns[j]) / (columns[j + 1] - columns[j])
    low = values[i, j] * (1 - t) + values[i, j + 1] * t
    high = values[i + 1, j] * (1 - t) + values[i + 1, j + 1] * t
    return float(low * (1 - s) + high * s)
