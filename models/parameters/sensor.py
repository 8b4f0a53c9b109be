"""The whole sensor: one object from which models, RTL, netlist, layout and documents are built."""

from dataclasses import dataclass
from math import hypot

from talbot.models.parameters.array import ArrayParameters
from talbot.models.parameters.checks import ParameterError, check_real
from talbot.models.parameters.chip import ChipParameters
from talbot.models.parameters.electrical import ConverterParameters, ElectricalParameters
from talbot.models.parameters.frame import Window
from talbot.models.parameters.optics import OpticsParameters
from talbot.models.parameters.spectral import SpectralParameters
from talbot.models.parameters.tile import TileParameters

CORNER = 1.75  # tangent under which a lens at most sees the array's corners, and these the lens: 60 degrees


@dataclass(frozen=True)
class SensorParameters:
    """All parameters of a sensor; by default the thesis's: 384 x 384 pixels in tiles of 4 x 6, f/1.2, eight lanes.

    The array has at most 256 x 256 tiles; its corners see the lens, and the lens them, under at
    most 60 degrees.

    Attributes
    ----------
    tile : TileParameters
        Pixel types and their order.
    array : ArrayParameters
        Size of the pixel array.
    optics : OpticsParameters
        Lens and gratings.
    electrical : ElectricalParameters
        Photodiode pair and amplifier.
    converter : ConverterParameters
        Imperfections of the converters.
    chip : ChipParameters
        Build-time parameters of the digital chip.
    spectral : SpectralParameters
        Gratings, quantum efficiency and filter by wavelength.
    """

    tile: TileParameters = TileParameters()
    array: ArrayParameters = ArrayParameters()
    optics: OpticsParameters = OpticsParameters()
    electrical: ElectricalParameters = ElectricalParameters()
    converter: ConverterParameters = ConverterParameters()
    chip: ChipParameters = ChipParameters()
    spectral: SpectralParameters = SpectralParameters()

    def __post_init__(self) -> None:
        if max(self.tile_rows, self.tile_cols) > 256:
            raise ParameterError(f"array = {self.array.rows} x {self.array.cols}: must be at most 256 x 256 tiles")
        lens, corner = self.optics.camera, self.array.pitch * hypot(self.array.rows, self.array.cols) / 2
        check_real("focal_length", lens.focal_length, corner / CORNER, max(1.0, corner))
        if lens.exit_pupil is not None:
            check_real("exit_pupil", lens.exit_pupil, corner / CORNER, 1000)

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns of the array."""
        return self.array.rows, self.array.cols

    @property
    def tile_rows(self) -> int:
        """Tiles down the array, the last perhaps partial."""
        return -(-self.array.rows // self.tile.rows)

    @property
    def tile_cols(self) -> int:
        """Tiles across the array, the last perhaps partial."""
        return -(-self.array.cols // self.tile.cols)

    @property
    def full_window(self) -> Window:
        """Window of the whole array."""
        return Window(0, self.tile_rows - 1, 0, self.tile_cols - 1)

    def check_window(self, window: Window) -> None:
        """Check that a window is inside the array.

        window: tiles to read. Raises ParameterError for a window that reaches past the last tile.
        """
        for axis, count in (("row", self.tile_rows), ("col", self.tile_cols)):
            last = getattr(window, f"{axis}1")
            if last >= count:
                raise ParameterError(f"window {axis}1 = {last}: must be in 0..{count - 1} (tiles)")
