"""Every top that can be exported: its name and how to build it for a sensor."""

from collections.abc import Callable

from pymtl3 import Component

from models.parameters import ParameterError, SensorParameters


def amp_ctrl(sensor: SensorParameters) -> Component:
    from rtl.amp_ctrl import AmpCtrl

    return AmpCtrl()


def readout_seq(sensor: SensorParameters) -> Component:
    from rtl.readout_seq import ReadoutSeq

    return ReadoutSeq(
        sensor.array.rows,
        sensor.array.cols,
        sensor.chip.lanes,
        tuple(sensor.tile.order),
        sensor.tile.rows,
        sensor.tile.cols,
    )


def edge_adc(sensor: SensorParameters) -> Component:
    from rtl.edge_adc import EdgeAdc

    return EdgeAdc()


def adc_bank(sensor: SensorParameters) -> Component:
    from rtl.adc_bank import AdcBank

    return AdcBank(sensor.chip.lanes)


def divider(variant: str) -> Callable[[SensorParameters], Component]:
    """How to build one variant of the quadrature divider."""

    def build(sensor: SensorParameters) -> Component:
        from rtl.quad_divider import quad_divider

        return quad_divider(variant, sensor.chip.n_frac, sensor.chip.cordic_iterations)

    return build


def phase_path(sensor: SensorParameters) -> Component:
    from rtl.phase_path import PhasePath

    return PhasePath(sensor.chip.lanes, sensor.chip.divider, sensor.chip.n_frac, sensor.chip.cordic_iterations)


def run_length(sensor: SensorParameters) -> Component:
    from rtl.run_length import RunLength

    return RunLength(sensor.array.rows, sensor.array.cols, sensor.chip.lanes, sensor.tile.rows, sensor.tile.cols)


def reg_file(sensor: SensorParameters) -> Component:
    from rtl.reg_file import RegFile

    return RegFile(sensor.tile_rows - 1, sensor.tile_cols - 1)


def asp_chip(sensor: SensorParameters) -> Component:
    from rtl.asp_chip import AspChip

    return AspChip(
        sensor.array.rows,
        sensor.array.cols,
        sensor.chip.lanes,
        tuple(sensor.tile.order),
        sensor.tile.rows,
        sensor.tile.cols,
        sensor.chip.divider,
        sensor.chip.n_frac,
        sensor.chip.cordic_iterations,
    )


TOPS: dict[
    str, Callable[[SensorParameters], Component]
] = {  # each imports its block when it is built: a block that is being changed stops only itself
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

# Of rtl.run_length.candidates: exported by name only, to measure their sizes
PACKERS = "BytePairPacker", "NibblePacker", "FixedRicePacker", "AdaptiveRicePacker", "PayloadPacker"


def build_top(name: str, sensor: SensorParameters) -> Component:
    """The unelaborated component of top or packer ``name`` for ``sensor``. Raises ParameterError."""
    if name in PACKERS:
        from rtl.run_length import candidates

        return getattr(candidates, name)()
    if name not in TOPS:
        raise ParameterError(f"top = {name!r}: must be one of {', '.join(TOPS)}")
    return TOPS[name](sensor)
