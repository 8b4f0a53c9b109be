"""Fields of a sensor that the drawn circuits can and cannot vary, with reasons, for `talbot.base.sensor.Varied`."""

from talbot.base.sensor import Varied
from talbot.models.parameters import STANDARD, ParameterError, check_real

PIXEL_PITCHES_UM = 10.0, 15.0  # at which pixels are drawn: at 9 um metal 1 breaks its rules, at 8 um implants too
PITCH_STEP_UM = 0.01  # half a pixel is on the manufacturing grid
DUMMIES = 2  # rows and columns on each side of a drawn array
DRAWN_PITCH = {"array.pitch": "the masks of pixels, rows and columns are drawn for this pitch"}
ARRAY_FIELDS = {"rows": "array.rows", "cols": "array.cols"}  # options that replace fields of the sensor
PIXEL_PITCH = {"array.pitch": (round(1e-6 * PIXEL_PITCHES_UM[0], 12), round(1e-6 * PIXEL_PITCHES_UM[1], 12))}
PIXEL_STEP = {"array.pitch": round(1e-6 * PITCH_STEP_UM, 12)}
DRAWN_ARRAY = Varied(used=(*ARRAY_FIELDS.values(), "array.pitch", "tile"), limits=PIXEL_PITCH, steps=PIXEL_STEP)
DRAWN_LINES = {"array.pitch": "resistance and capacitance of lines are those of pixels drawn on this pitch"}
DRAWN_SIZES = dict.fromkeys(
    (
        "chip.f_clk",
        *(f"electrical.{name}" for name in ("full_well", "swing", "difference_gain")),
        *(f"converter.{name}" for name in ("inl", "offset", "noise", "ktc")),
    ),
    "transistors are drawn in the sizes that the standard sensor needs",
)
DRAWN_BLOCKS = Varied(  # row drivers, column amplifiers, converters
    used=(*ARRAY_FIELDS.values(), "array.pitch", "chip.lanes"),
    fixed=DRAWN_SIZES,
    limits={
        "array.rows": (1, STANDARD.array.rows),
        "array.cols": (1, STANDARD.array.cols),
        "chip.lanes": (1, STANDARD.chip.lanes),
        **PIXEL_PITCH,
    },
    steps=PIXEL_STEP,
)


def check_pitch(pitch_um: float) -> None:
    """Raise ParameterError for a pitch at which nothing is drawn."""
    check_real("array.pitch_um", pitch_um, *PIXEL_PITCHES_UM, "um")
    steps = pitch_um / PITCH_STEP_UM
    if abs(steps - round(steps)) > 1e-6:
        raise ParameterError(f"array.pitch_um = {pitch_um}: must be a multiple of {PITCH_STEP_UM:g} um")
