"""Configuration of a frame: the contents of the chip's registers, by their meaning."""

from dataclasses import dataclass, fields, replace

from talbot.models.parameters.checks import ParameterError, check_choice, check_int

MODES = ("edge", "image", "raw", "tof", "ternary")  # in the order of the register's code
SIGNED = ("edge", "ternary")  # of the difference: code 0 at mid-scale, with a zero window
SAMPLES_PER_PIXEL = {"edge": 1, "image": 1, "raw": 2, "tof": 4, "ternary": 1}
ALL_TYPES = (1 << 24) - 1
EXPOSURE_MAX = 1023  # rows


def mode_of(code: int) -> str:
    """Mode that the register's code selects.

    code: 0..7. The chip decodes bit 2 in edge mode alone: 5 to 7 are as 1 to 3. Returns one of MODES.
    """
    return MODES[code if code < len(MODES) else code & 3]


@dataclass(frozen=True)
class AmpTiming:
    """Durations of the amplifier's phases, the number of common-mode resets, and the lead of the reset pointer.

    Attributes
    ----------
    t_reset, t_int, t_cm, t_settle, t_read, t_guard : int
        Cycles, each 1..65535.
    n_cm : int
        Common-mode resets during the integration, 0..255.
    exposure : int
        Rows by which the reset pointer leads the read pointer, 0..1023; 0 in time of flight, whatever it is.
    """

    t_reset: int = 32
    t_int: int = 512
    t_cm: int = 16
    t_settle: int = 16
    t_read: int = 16
    t_guard: int = 2
    n_cm: int = 0
    exposure: int = 0

    def __post_init__(self) -> None:
        ends = {"n_cm": (0, 255), "exposure": (0, EXPOSURE_MAX)}
        for f in fields(self):
            check_int(f.name, getattr(self, f.name), *ends.get(f.name, (1, 65535)))


SHORT_TIMING = AmpTiming(t_reset=2, t_int=3, t_cm=2, t_settle=2, t_read=2, t_guard=1, n_cm=1)  # of simulated frames


@dataclass(frozen=True)
class Window:
    """Tiles to read, both ends included.

    Attributes
    ----------
    row0, row1, col0, col1 : int
        0 <= row0 <= row1 <= 255 and 0 <= col0 <= col1 <= 255.
    """

    row0: int
    row1: int
    col0: int
    col1: int

    def __post_init__(self) -> None:
        for axis in ("row", "col"):
            low, high = getattr(self, f"{axis}0"), getattr(self, f"{axis}1")
            check_int(f"window {axis}0", low, 0, 255)
            check_int(f"window {axis}1", high, 0, 255)
            if low > high:
                raise ParameterError(f"window {axis}0..{axis}1 = {low}..{high}: must not be inverted")


@dataclass(frozen=True)
class FrameParameters:
    """Configuration of one frame.

    Attributes
    ----------
    window : Window
        Tiles to read.
    mode : str
        'edge' (difference), 'image' (sum), 'raw' (both diodes), 'tof' (four taps) or 'ternary' (sign of the
        difference, or 0).
    mask : int
        Bit t set = pixel type t is read, 1..2**24-1.
    threshold : int
        0..127 codes; edge and ternary mode; 0 converts every sample of edge mode.
    decimation : int
        Log2 of the tile step, 0..3 (every 1, 2, 4 or 8 tiles, from the window's corner).
    phase : bool
        In tof mode, send (phase, amplitude) from the divider instead of the taps.
    noise_floor : int
        Amplitude below which the divider's phase is not valid, 0..255.
    overlap : bool
        Integrate the next row while this one converts.
    test_pattern : bool
        Replace the comparators by a digital pattern.
    frame_number : int
        0..65535.
    timing : AmpTiming
        Durations of the amplifier's phases.
    resync : int
        A mark follows the first row that ends 64 * resync bytes or more behind the mark before, 0..3 (0: every row).
    calibration : int
        The host's number for its trims, gain and clock, 0..255; the stream carries it.
    """

    window: Window
    mode: str = "edge"
    mask: int = ALL_TYPES
    threshold: int = 10
    decimation: int = 0
    phase: bool = False
    noise_floor: int = 0
    overlap: bool = True
    test_pattern: bool = False
    frame_number: int = 0
    timing: AmpTiming = AmpTiming()
    resync: int = 2
    calibration: int = 0

    def __post_init__(self) -> None:
        check_choice("mode", self.mode, MODES)
        check_int("mask", self.mask, 1, ALL_TYPES)
        check_int("threshold", self.threshold, 0, 127)
        check_int("decimation", self.decimation, 0, 3)
        check_int("noise_floor", self.noise_floor, 0, 255)
        check_int("frame_number", self.frame_number, 0, 65535)
        check_int("resync", self.resync, 0, 3)
        check_int("calibration", self.calibration, 0, 255)
        for name in ("phase", "overlap", "test_pattern"):
            check_choice(name, getattr(self, name), (False, True))
        if self.phase and self.mode != "tof":
            raise ParameterError(f"phase = True: needs mode 'tof', not {self.mode!r}")

    @property
    def exposing(self) -> AmpTiming:
        """The timing as the chip exposes with it: in time of flight each tap has its own reset, and nothing leads."""
        return replace(self.timing, exposure=0) if self.mode == "tof" else self.timing
