"""The capacitor of each unit of a 16 x 16 array, in common centroid.

Every unit but two has its partner of the same capacitor on the other side of the array's middle, at the same distance:
what changes along a line across the array cancels. The two that are alone, the lowest bit and the terminator, are
side by side at the middle. A column has 8 units of the highest bit in a checkerboard, 4 of the next, 2, 1, and 1
of a small one.
"""

import numpy as np
import numpy.typing as npt

SIDE = 16
SMALL = ("bit3", "bit3", "bit3", "bit2", "bit3", "bit2", "bit1", "bit0")  # of the western columns, outermost first


def binary() -> npt.NDArray[np.str_]:
    """Names bit7 .. bit0 and terminator; [row, column], row 0 in the south."""
    names = np.full((SIDE, SIDE), "", dtype="<U10")
    for column in range(SIDE // 2):
        free = [row for row in range(SIDE) if (row + column) % 2 == 0]
        small = 3 if column == SIDE // 2 - 1 else (2 * column + 1) % 8  # of the free places; the last at the middle
        rest = range(small + 2, small + 8, 2)
        for place, row in enumerate(free):
            names[row, column] = "bit6" if (place - small) % 2 else ""
        names[free[small], column] = SMALL[column]
        for place, name in zip(rest, ("bit5", "bit4", "bit5"), strict=True):
            names[free[place % 8], column] = name
        names[[row for row in range(SIDE) if row not in free], column] = "bit7"
    turned = names[::-1, ::-1]
    names[:, SIDE // 2 :] = turned[:, SIDE // 2 :]
    names[SIDE // 2, SIDE // 2] = "terminator"
    return names


def halves() -> npt.NDArray[np.str_]:
    """Names refp and refn in a checkerboard: each has its partner, too."""
    row, column = np.indices((SIDE, SIDE))
    return np.where((row + column) % 2 == 0, "refp", "refn")
