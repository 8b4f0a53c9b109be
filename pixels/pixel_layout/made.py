"""The drawn pixel array of a sensor, and its files."""

from dataclasses import dataclass
from pathlib import Path

from talbot.pixels.layout.array import ArrayLayout
from talbot.pixels.layout.pixel import PixelLayout

SMALL = 6, 8  # rows and columns of the array that is checked: with its dummies every type meets all its neighbours


@dataclass(frozen=True)
class Made:
    """The array, the small one that is checked, and the folder of the files."""

    array: ArrayLayout
    small: ArrayLayout
    folder: Path

    @property
    def shown(self) -> PixelLayout:
        """The pixel of which pictures are: of the finest gratings, along x."""
        return max(self.array.pixels, key=lambda pixel: (pixel.kind.beta, -abs(pixel.kind.gamma_deg)))

    def path(self, name: str) -> Path:
        """Return a file."""
        return self.folder / name
