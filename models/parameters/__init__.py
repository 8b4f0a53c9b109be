"""All parameters: frozen, validated, with unit, range and source."""

from .array import COLS_MAX, ROWS_MAX, ArrayParameters
from .camera import FOCUS_MAX, LIFE_SIZE, CameraParameters
from .checks import ParameterError, check_choice, check_int, check_real
from .chip import ASYNCHRONOUS, LANES, SPI_INPUTS, ChipParameters
from .circuit import DIODE, DRAWN, ColumnCurves, circuit_columns, circuit_converter
from .divider import DIVIDERS
from .drawn import LineParameters, drawn_curves, drawn_electrical, drawn_lines
from .electrical import ELEMENTARY_CHARGE, TYPICAL_CONVERTER, ConverterParameters, ElectricalParameters
from .energy import EnergyParameters, LightParameters
from .frame import ALL_TYPES, EXPOSURE_MAX, MODES, SAMPLES_PER_PIXEL, SHORT_TIMING, AmpTiming, FrameParameters, Window
from .optics import OpticsParameters
from .room import RoomParameters
from .sensor import SensorParameters
from .sensor_file import STANDARD, read_sensor, sensor_of, sensor_text
from .sources import sources
from .tile import PixelType, Response, TileParameters

__all__ = [
    "ALL_TYPES",
    "ASYNCHRONOUS",
    "COLS_MAX",
    "DIODE",
    "DIVIDERS",
    "DRAWN",
    "ELEMENTARY_CHARGE",
    "EXPOSURE_MAX",
    "FOCUS_MAX",
    "LANES",
    "LIFE_SIZE",
    "LightParameters",
    "LineParameters",
    "MODES",
    "ROWS_MAX",
    "SAMPLES_PER_PIXEL",
    "SPI_INPUTS",
    "SHORT_TIMING",
    "STANDARD",
    "TYPICAL_CONVERTER",
    "AmpTiming",
    "ArrayParameters",
    "CameraParameters",
    "ChipParameters",
    "ConverterParameters",
    "ElectricalParameters",
    "EnergyParameters",
    "FrameParameters",
    "OpticsParameters",
    "ParameterError",
    "PixelType",
    "Response",
    "RoomParameters",
    "SensorParameters",
    "TileParameters",
    "Window",
    "check_choice",
    "check_int",
    "check_real",
    "ColumnCurves",
    "circuit_columns",
    "circuit_converter",
    "drawn_curves",
    "drawn_electrical",
    "drawn_lines",
    "read_sensor",
    "sensor_of",
    "sensor_text",
    "sources",
]
