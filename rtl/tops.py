"""The tops that can be exported: their names, and how to build each for a sensor.

A block is imported when it is built: listing the names needs no PyMTL, and an error in a block affects only that block.
"""

from collections.abc import Callable
from typing import TYPE_CHECKING

from talbot.models.parameters import ParameterError, SensorParameters
from talbot.models.parameters.registers import register_map

if TYPE_CHECKING:
    from pymtl3 import Component

Build = Callable[[SensorParameters], "Component"]


def _array(sensor: SensorParameters) -> tuple[int, int, int, tuple[int, ...], int, int]:
    """Return the parameters that depend on the array: rows, cols, lanes, order, tile_rows, tile_cols."""
    array, tile = sensor.array, sensor.tile
    return array.rows, array.cols, sensor.chip.lanes, tuple(tile.order), tile.rows, tile.cols


def amp_ctrl(sensor: SensorParameters) -> "Component":
    """Return the amplifier control."""
    from talbot.rtl.amp_ctrl import AmpCtrl

    return AmpCtrl()


def readout_seq(sensor: SensorParameters) -> "Component":
    """Return the readout sequencer."""
    from talbot.rtl.readout_seq import ReadoutSeq

    return ReadoutSeq(*_array(sensor))


def edge_adc(sensor: SensorParameters) -> "Component":
    """Return one converter lane."""
    from talbot.rtl.edge_adc import EdgeAdc

    return EdgeAdc()


def adc_bank(sensor: SensorParameters) -> "Component":
    """Return the converters of all lanes."""
    from talbot.rtl.adc_bank import AdcBank

    return AdcBank(sensor.chip.lanes)


def divider(variant: str) -> Build:
    """Return the function that builds one variant of the quadrature divider."""

    def build(sensor: SensorParameters) -> "Component":
        from talbot.rtl.quad_divider import quad_divider

        return quad_divider(variant, sensor.chip.n_frac, sensor.chip.cordic_iterations)

    return build


def phase_path(sensor: SensorParameters) -> "Component":
    """Return the phase path. Raises ParameterError for a sensor without."""
    check_block("top = 'PhasePath'", "PhasePath", sensor)
    from talbot.rtl.phase_path import PhasePath

    return PhasePath(sensor.chip.lanes, sensor.chip.divider, sensor.chip.n_frac, sensor.chip.cordic_iterations)


def run_length(sensor: SensorParameters) -> "Component":
    """Return the stream encoder."""
    from talbot.rtl.run_length import RunLength

    return RunLength(sensor.array.rows, sensor.array.cols, sensor.chip.lanes, sensor.tile.rows, sensor.tile.cols)


def reg_file(sensor: SensorParameters) -> "Component":
    """Return the register file."""
    from talbot.rtl.reg_file import RegFile

    array, tile, chip = sensor.array, sensor.tile, sensor.chip
    return RegFile(array.rows, array.cols, chip.lanes, tile.rows, tile.cols, chip.divider)


def asp_chip(sensor: SensorParameters) -> "Component":
    """Return the chip."""
    from talbot.rtl.asp_chip import AspChip

    chip = sensor.chip
    return AspChip(*_array(sensor), chip.divider, chip.n_frac, chip.cordic_iterations)


TOPS: dict[str, Build] = {
    "AmpCtrl": amp_ctrl,
    "ReadoutSeq": readout_seq,
    "EdgeAdc": edge_adc,
    "AdcBank": adc_bank,
    "QuadDividerRadix2": divider("radix2"),
    "QuadDividerRadix4": divider("radix4"),
    "QuadDividerPipelined": divider("pipelined"),
    "Cordic": divider("cordic"),
    "PhasePath": phase_path,
    "RunLength": run_length,
    "RegFile": reg_file,
    "AspChip": asp_chip,
}


def balance(sensor: SensorParameters) -> "Component":
    """Return the lookup of the trim of the pixel at the pins."""
    from talbot.rtl.asp_chip.balance_rtl import Balance

    trims = register_map().trims[0]
    tile = sensor.tile
    return Balance(tuple(tile.order), tile.rows, tile.cols, trims.width, 8 * trims.size)


def pattern(sensor: SensorParameters) -> "Component":
    """Return the test pattern generator."""
    from talbot.rtl.asp_chip.pattern_rtl import Pattern

    return Pattern(sensor.chip.lanes)


def proc(sensor: SensorParameters) -> "Component":
    """Return the processor of test chip 1, the same for any sensor."""
    from talbot.rtl.proc import Proc

    return Proc()


def test_chip_1(sensor: SensorParameters) -> "Component":
    """Return test chip 1, the same for any sensor."""
    from talbot.rtl.test_chip_1 import TestChip1

    return TestChip1()


# Another design, without coverage and mutants
TEST_CHIP_1: dict[str, Build] = {"Proc": proc, "TestChip1": test_chip_1}

# Of AspChip, to be proven for any sensor, and of the other design: exported by name only
PARTS: dict[str, Build] = {"Balance": balance, "Pattern": pattern, **TEST_CHIP_1}

# Of rtl.tinytapeout: Verilog around a top, exported by name only
WRAPPERS = {
    "tt_um_talbot_divider": "QuadDividerRadix4",
    "tt_um_talbot_amp_ctrl": "AmpCtrl",
    "tt_um_talbot_chip": "AspChip",
}


def tops_of(sensor: SensorParameters) -> list[str]:
    """Return the names of the TOPS that ``sensor`` has."""
    return [name for name in TOPS if name != "PhasePath" or sensor.chip.has_phase_path]


def check_block(field: str, name: str, sensor: SensorParameters) -> None:
    """Check that ``sensor`` has the top ``name``. field: with its value, for the error. Raises ParameterError."""
    if name in TOPS and name not in tops_of(sensor):
        raise ParameterError(f"{field}: must be a block of the sensor, whose chip.divider is none")


def build_top(name: str, sensor: SensorParameters) -> "Component":
    """Return the unelaborated component of top or part ``name`` for ``sensor``. Raises ParameterError."""
    if name not in TOPS | PARTS:
        raise ParameterError(f"top = {name!r}: must be one of {', '.join(TOPS)}")
    return (TOPS | PARTS)[name](sensor)
