"""What the drawn blocks can bear, said before anything is drawn."""

from talbot.models.parameters import SensorParameters
from talbot.pixels.analog_layout.column_amplifiers import frame
from talbot.pixels.analog_layout.columns import check_columns
from talbot.pixels.blocks import AnalogSizes, blocks
from talbot.pixels.circuits.column_sizes import ColumnSpec
from talbot.pixels.circuits.row_driver import RowDriverSpec


def check_drawable(sensor: SensorParameters) -> None:
    """Check that the blocks have room for their pins, and that columns and rows can drive their lines.

    Raises ParameterError.
    """
    array, chip = sensor.array, sensor.chip
    blocks(array, chip)
    ColumnSpec.of_drawn(sensor)
    RowDriverSpec.of(sensor)
    check_columns(array, chip.lanes)
    frame(array, chip, AnalogSizes.of(array, chip))
