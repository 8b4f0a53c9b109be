"""Every top that can be exported: its name and how to build it for a sensor."""

from models.parameters import ParameterError


def reg_file(sensor):
    from rtl.reg_file import RegFile
    return RegFile(sensor.tile_rows - 1, sensor.tile_cols - 1)


TOPS = {
    "RegFile": reg_file,
}


def build_top(name, sensor):
    """The unelaborated component of top ``name`` for ``sensor`` (SensorParameters). Raises ParameterError."""
    if name not in TOPS:
        raise ParameterError(f"top = {name!r}: must be one of {', '.join(TOPS)}")
    return TOPS[name](sensor)
