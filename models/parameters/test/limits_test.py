"""Ranges, defaults and the order of names, typed from docs/registers.md, docs/host.md and docs/limits.md."""

import pytest

from talbot.models.parameters import (
    DIVIDERS,
    LANES,
    MODES,
    SAMPLES_PER_PIXEL,
    SIGNED,
    AmpTiming,
    ArrayParameters,
    ChipParameters,
    FrameParameters,
    ParameterError,
    PixelType,
    TileParameters,
    Window,
    mode_of,
)
from talbot.models.parameters.array import COLS_MAX, ROWS_MAX
from talbot.models.parameters.divider import (
    AMP_MAX,
    ITERATIONS_MAX,
    ITERATIONS_MIN,
    N_FRAC_MAX,
    N_FRAC_MIN,
    OCTANT,
    SAMPLE_MAX,
    SAMPLE_MIN,
    TURN,
    cordic_angles,
    phase_thresholds,
)
from talbot.models.parameters.frame import ALL_TYPES, EXPOSURE_MAX

TILE = Window(0, 0, 0, 0)


def frame(**fields):
    return FrameParameters(TILE, **fields)


def window(**fields):
    return Window(**({"row0": 0, "row1": 255, "col0": 0, "col1": 255} | fields))


def pixel(**fields):
    return PixelType(**({"beta": 12, "gamma_deg": 0, "alpha": 0} | fields))


RANGES = [
    (ArrayParameters, "rows", 1, 1024),
    (ArrayParameters, "cols", 1, 1536),
    (ArrayParameters, "pitch", 1e-7, 1e-3),
    (ChipParameters, "n_frac", 4, 16),
    (ChipParameters, "cordic_iterations", 4, 16),
    (ChipParameters, "f_clk", 1e3, 1e9),
    *((AmpTiming, name, 1, 65535) for name in ("t_reset", "t_int", "t_cm", "t_settle", "t_read", "t_guard")),
    (AmpTiming, "n_cm", 0, 255),
    (AmpTiming, "exposure", 0, 1023),
    *((window, name, 0, 255) for name in ("row0", "row1", "col0", "col1")),
    (frame, "mask", 1, 0xFFFFFF),
    (frame, "threshold", 0, 127),
    (frame, "decimation", 0, 3),
    (frame, "noise_floor", 0, 255),
    (frame, "frame_number", 0, 65535),
    (frame, "resync", 0, 3),
    (frame, "calibration", 0, 255),
    (pixel, "beta", 0, 50),
    (pixel, "gamma_deg", -180, 180),
    (pixel, "alpha", -6.2832, 6.2832),
    (pixel, "m", 0, 1),
]


@pytest.mark.parametrize("make, name, least, most", RANGES, ids=lambda value: value if isinstance(value, str) else "")
def test_range(make, name, least, most):
    for value in (least, most):
        assert getattr(make(**{name: value}), name) == value
    below, above = (least - 1, most + 1) if isinstance(most, int) else (least - abs(least) / 50, most + most / 50)
    for value in (below, above):
        with pytest.raises(ParameterError, match=f"{name} = "):
            make(**{name: value})


def test_tiles():
    """1 x 1 to 4 x 6 pixels."""
    for rows, cols in ((1, 1), (4, 6)):
        assert TileParameters.small(rows, cols).n_types == rows * cols
    for rows, cols in ((0, 1), (5, 1), (1, 0), (1, 7)):
        for make in (TileParameters.small, lambda *size: TileParameters(*size, [pixel()] * 24, range(24))):
            with pytest.raises(ParameterError, match="tile"):
                make(rows, cols)


def test_defaults():
    """The values after reset of docs/registers.md, in the order of the fields."""
    assert AmpTiming() == AmpTiming(32, 512, 16, 16, 16, 2, 0, 0)
    assert frame() == FrameParameters(TILE, "edge", 0xFFFFFF, 10, 0, False, 0, True, False, 0, AmpTiming(), 2, 0)
    assert ChipParameters() == ChipParameters(8, "radix4", 8, 10, 10e6)


def test_names_in_the_order_of_their_codes():
    assert MODES == ("edge", "image", "raw", "tof", "ternary")
    assert SAMPLES_PER_PIXEL == {"edge": 1, "image": 1, "raw": 2, "tof": 4, "ternary": 1}
    assert SIGNED == ("edge", "ternary")
    assert [mode_of(code) for code in range(8)] == [*MODES, "image", "raw", "tof"]
    assert DIVIDERS == ("radix2", "radix4", "pipelined", "cordic")
    assert LANES == (1, 2, 4, 8, 16, 32)


def test_sizes_of_the_formats():
    """256 tiles each way; differences of bytes; a turn is 256 and has eight octants."""
    assert (ROWS_MAX, COLS_MAX) == (256 * 4, 256 * 6)
    assert (ALL_TYPES, EXPOSURE_MAX) == (0xFFFFFF, 1023)
    assert (SAMPLE_MIN, SAMPLE_MAX, AMP_MAX) == (-256, 255, 255)
    assert (TURN, 8 * OCTANT) == (256, 256)
    assert (N_FRAC_MIN, N_FRAC_MAX, ITERATIONS_MIN, ITERATIONS_MAX) == (4, 16, 4, 16)


def test_tables_of_the_divider():
    """An angle a step; 16 tan(2 pi 31.5 / 256) - 0.5 = 15.1 rounds up to 16, and four bits hold 15 at most."""
    assert [len(cordic_angles(n)) for n in (4, 16)] == [4, 16]
    assert phase_thresholds(4)[-1] == 15
