"""Files of the drawn analog blocks for the die, each compared with its circuit first.

`python -m talbot.pixels.post_layout.write`
"""

import argparse
import sys
from pathlib import Path

from talbot.base.command import main
from talbot.base.files import staged
from talbot.base.gds import write_gds
from talbot.base.sensor import add_sensor, sensor_asked
from talbot.base.steps import StepError
from talbot.models.parameters import STANDARD, SensorParameters
from talbot.pixels.analog_layout.column_amplifiers import NAME as COLUMNS
from talbot.pixels.analog_layout.column_amplifiers import draw_column_amplifiers
from talbot.pixels.analog_layout.converters import NAME as CONVERTERS
from talbot.pixels.analog_layout.converters import draw_converters
from talbot.pixels.analog_layout.drawn_block import DrawnBlock
from talbot.pixels.analog_layout.row_drivers import NAME as ROWS
from talbot.pixels.analog_layout.row_drivers import draw_row_drivers
from talbot.pixels.blocks import AnalogSizes
from talbot.pixels.datasheet.job import amplifier_of, column_of, setup_of
from talbot.pixels.drawn import DRAWN_BLOCKS
from talbot.pixels.post_layout.checks import differences, lvs
from talbot.platforms.analog import analog_masks


def drawn_blocks(pdk: str, sensor: SensorParameters = STANDARD) -> dict[str, DrawnBlock]:
    """Converters, rows' drivers, column amplifiers, by name, for the array and chip. Raises ParameterError."""
    array, chip = sensor.array, sensor.chip
    masks, (setup, sizes), room = analog_masks(pdk), setup_of(pdk), AnalogSizes.of(array, chip)
    return {
        CONVERTERS: draw_converters(masks, sizes, amplifier_of(setup, sizes)[1], chip, room),
        ROWS: draw_row_drivers(masks, array, room),
        COLUMNS: draw_column_amplifiers(masks, column_of(setup)[1], array, chip, room),
    }


def write(out: Path, pdk: str, sensor: SensorParameters = STANDARD) -> None:
    """Write <block>.lef and <block>.gds of all into ``out``. Raises StepError where one is not its circuit."""
    masks = analog_masks(pdk)
    with staged(out) as part:
        for name, block in drawn_blocks(pdk, sensor).items():
            (part / f"{name}.lef").write_text(block.lef(masks), encoding="utf-8")
            write_gds(block.layout, part / f"{name}.gds", block.cell)
            report = part / f"{name}.lvsdb"
            if not lvs(part / f"{name}.gds", block.spice(masks), pdk, report, block.boxes):
                raise StepError(f"{name}: the layout is not the circuit: {', '.join(differences(report)[:5])}")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Options of `python -m talbot.pixels.post_layout.write`."""
    parser.add_argument("--pdk", default="sky130", help="process")
    add_sensor(parser)
    parser.add_argument("--out", type=Path, required=True, help="folder of the files")


def run(options: argparse.Namespace) -> int:
    """Write the files."""
    write(options.out, options.pdk, sensor_asked(options, DRAWN_BLOCKS))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.modules[__name__]))
