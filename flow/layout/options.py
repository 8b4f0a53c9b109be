"""What a user chooses for a layout: process, utilization, cells' timing, the foundry's decks."""

import re
from dataclasses import dataclass
from pathlib import Path

from talbot.base.liberty.read import is_library, is_whole, names, text_of
from talbot.flow.layout import tables
from talbot.models.parameters import ParameterError, check_real
from talbot.platforms.layout import layout_platform
from talbot.platforms.place_and_route import place_and_route

LEAST_UTILIZATION = 0.20  # of the search's last attempt


def corner_of(path: Path) -> str:
    """The name of the corner of a Liberty file: that of the file, in characters that all tools take."""
    return re.sub(r"[^A-Za-z0-9_.-]", "_", path.stem)


@dataclass(frozen=True)
class Options:
    """Choices for one layout.

    pdk: process. utilization: area of the synthesized cells by core area at which the search begins. liberty:
    characterized cells, a file a corner; () for the process's corners, as shipped (`tables`). decks: pairs (name, path)
    of the foundry's own checks (`platforms.foundry`).
    """

    pdk: str = "sky130"
    utilization: float = 0.8
    liberty: tuple[Path, ...] = ()
    decks: tuple[tuple[str, Path], ...] = ()

    @property
    def corners(self) -> tuple[str, ...]:
        """Names of the corners, that of synthesis first."""
        return tuple(map(corner_of, self.liberty)) or layout_platform(self.pdk).corners

    def __post_init__(self) -> None:
        place_and_route(self.pdk)
        for path in self.liberty:
            if not path.is_file():
                without = "without LIBERTY the shipped ones are taken, in build/layout/shared/timing.* after a layout"
                raise ParameterError(f"liberty = {path}: no such file; {without}")
            if not is_library(path):
                raise ParameterError(f"liberty = {path}: must be a Liberty file: it does not begin with library (...)")
            if not is_whole(path):
                raise ParameterError(f"liberty = {path}: must be a whole Liberty file: it does not end with a brace")
            lacking = sorted(tables.cells(self.pdk) - (cells := names(text_of(path))))
            if lacking:
                have = f"has {', '.join(sorted(cells)[:3])}, " if cells else ""
                also = f" and {len(lacking) - 3} others" if len(lacking) > 3 else ""
                raise ParameterError(
                    f"liberty = {path}: must have the cells that a layout on {self.pdk} is made of: "
                    f"{have}lacks {', '.join(lacking[:3])}{also} (make layout-timing characterizes these)"
                )
        if len({corner_of(path) for path in self.liberty}) != len(self.liberty):
            raise ParameterError(f"liberty = {', '.join(map(str, self.liberty))}: must be of different corners")
        check_real("utilization", self.utilization, LEAST_UTILIZATION, 0.95)
