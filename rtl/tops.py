"""Every top that can be exported: its name and how to build it for a sensor."""

from models.parameters import ParameterError


def reg_file(sensor):
    from rtl.reg_file import RegFile
    return RegFile(sensor.tile_rows - 1, sensor.tile_cols - 1)


def asp_chip(sensor):
    from rtl.asp_chip import AspChip
    return AspChip(sensor.array.rows, sensor.array.cols, sensor.chip.lanes, tuple(sensor.tile.order), sensor.tile.rows,
                   sensor.tile.cols, sensor.chip.divider, sensor.chip.n_frac, sensor.chip.cordic_iterations)


def quad_divider(sensor):
    from rtl.quad_divider import quad_divider
    return quad_divider(sensor.chip.divider, sensor.chip.n_frac, sensor.chip.cordic_iterations)


def run_length(sensor):
    from rtl.run_length import RunLength
    return RunLength(sensor.array.rows, sensor.array.cols, sensor.chip.lanes, sensor.tile.rows, sensor.tile.cols)


TOPS = {
    "AspChip": asp_chip,
    "QuadDivider": quad_divider,
    "RegFile": reg_file,
    "RunLength": run_length,
}


def build_top(name, sensor):
    """The unelaborated component of top ``name`` for ``sensor`` (SensorParameters). Raises ParameterError."""
    if name not in TOPS:
        raise ParameterError(f"top = {name!r}: must be one of {', '.join(TOPS)}")
    return TOPS[name](sensor)
