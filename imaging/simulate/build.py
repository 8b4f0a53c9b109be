"""Parameters of an elaborated simulator of the frame bench."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from talbot.models.parameters import SensorParameters
from talbot.rtl.verilog import export_verilog


@dataclass(frozen=True)
class Build:
    """The chip's constants and the array's size.

    order: pixel type of each position in a tile, row by row. waves: format of the waves that the program can write, of
    frame.WAVES, or "" for none.
    """

    rows: int
    cols: int
    lanes: int
    divider: str
    n_frac: int
    iterations: int
    tile_rows: int
    tile_cols: int
    order: tuple[int, ...]
    waves: str

    @classmethod
    def of(cls, sensor: SensorParameters, waves: str = "") -> "Build":
        """Return the Build of a sensor."""
        array, chip, tile = sensor.array, sensor.chip, sensor.tile
        iterations = chip.cordic_iterations
        sizes = array.rows, array.cols, chip.lanes, chip.divider, chip.n_frac, iterations, tile.rows, tile.cols
        return cls(*sizes, tile.order, waves)

    def parameters(self, option: str) -> list[str]:
        """Each parameter of the module Bench as ``option``NAME=value."""
        names = "rows", "cols", "lanes", "tile_rows", "tile_cols"
        return [f"{option}{name.upper()}={getattr(self, name)}" for name in names]

    def chip_verilog(self, folder: Path) -> Path:
        """Export the chip into ``folder``; returns AspChip.sv. Raises ToolError."""
        names = "rows", "cols", "lanes", "divider", "n_frac", "iterations", "tile_rows", "tile_cols"
        options: Sequence[str] = [
            *(f"--{name.replace('_', '-')}={getattr(self, name)}" for name in names),
            f"--order={','.join(map(str, self.order))}",
        ]
        (path,) = export_verilog(folder, ["AspChip"], options)
        return path
