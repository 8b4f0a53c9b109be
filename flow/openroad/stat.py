"""Counts of Yosys' command stat, in the formats of releases up to 2024 and since."""

import re

CELLS = re.compile(r"Number of cells:\s+(\d+)|^\s+(\d+)\s+\S+\s+cells$", re.M)
AREA = re.compile(r"Chip area for (?:top )?module[^:]*:\s+([\d.]+)")


def counted(text: str) -> tuple[int | None, float | None]:
    """Number of cells and their area in um2 of the flat design in ``text``; None where they are missing."""
    cells, area = CELLS.search(text), AREA.search(text)
    return int(cells[1] or cells[2]) if cells else None, float(area[1]) if area else None
