"""All parameters: frozen, validated, with unit, range and source."""

from talbot.models.parameters.array import COLS_MAX, ROWS_MAX, ArrayParameters
from talbot.models.parameters.camera import FOCUS_MAX, LIFE_SIZE, CameraParameters
from talbot.models.parameters.checks import ParameterError, check_choice, check_int, check_real
from talbot.models.parameters.chip import ASYNCHRONOUS, LANES, SPI_INPUTS, ChipParameters
from talbot.models.parameters.circuit import (
    DIODE,
    DRAWN,
    ColumnCurves,
    circuit_columns,
    circuit_converter,
    circuit_electrical,
)
from talbot.models.parameters.divider import DIVIDERS, NO_DIVIDER
from talbot.models.parameters.drawn import LineParameters, drawn_curves, drawn_electrical, drawn_lines
from talbot.models.parameters.electrical import ELEMENTARY_CHARGE, ConverterParameters, ElectricalParameters
from talbot.models.parameters.energy import CircuitEnergy, EnergyParameters, LightParameters
from talbot.models.parameters.frame import (
    ALL_TYPES,
    EXPOSURE_MAX,
    MODES,
    SAMPLES_PER_PIXEL,
    SHORT_TIMING,
    SIGNED,
    AmpTiming,
    FrameParameters,
    Window,
    mode_of,
)
from talbot.models.parameters.optics import OpticsParameters
from talbot.models.parameters.room import RoomParameters
from talbot.models.parameters.sensor import SensorParameters
from talbot.models.parameters.sensor_file import STANDARD, read_sensor, sensor_of, sensor_text
from talbot.models.parameters.sources import sources
from talbot.models.parameters.spectra import LIGHTS, SURFACES, Spectrum, light, surface
from talbot.models.parameters.spectral import SpectralParameters
from talbot.models.parameters.tile import PixelType, Response, TileParameters

__all__ = [
    "ALL_TYPES",
    "ASYNCHRONOUS",
    "COLS_MAX",
    "DIODE",
    "DIVIDERS",
    "NO_DIVIDER",
    "DRAWN",
    "ELEMENTARY_CHARGE",
    "EXPOSURE_MAX",
    "FOCUS_MAX",
    "LANES",
    "LIFE_SIZE",
    "LIGHTS",
    "LightParameters",
    "LineParameters",
    "MODES",
    "ROWS_MAX",
    "SAMPLES_PER_PIXEL",
    "SPI_INPUTS",
    "SHORT_TIMING",
    "SIGNED",
    "SURFACES",
    "STANDARD",
    "AmpTiming",
    "ArrayParameters",
    "CameraParameters",
    "ChipParameters",
    "ConverterParameters",
    "ElectricalParameters",
    "CircuitEnergy",
    "EnergyParameters",
    "FrameParameters",
    "OpticsParameters",
    "ParameterError",
    "PixelType",
    "Response",
    "RoomParameters",
    "SensorParameters",
    "SpectralParameters",
    "Spectrum",
    "TileParameters",
    "Window",
    "check_choice",
    "check_int",
    "check_real",
    "ColumnCurves",
    "circuit_columns",
    "circuit_converter",
    "circuit_electrical",
    "drawn_curves",
    "drawn_electrical",
    "drawn_lines",
    "light",
    "mode_of",
    "read_sensor",
    "sensor_of",
    "sensor_text",
    "sources",
    "surface",
]
