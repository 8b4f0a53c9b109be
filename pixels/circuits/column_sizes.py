"""Specification and sizes of a column, from the sensor, the chip's timing and Table 6.1: see column.py."""

from dataclasses import dataclass, replace
from math import ceil, log
from types import ModuleType
from typing import Self

from talbot.models.parameters import (
    DIODE,
    ELEMENTARY_CHARGE,
    AmpTiming,
    EnergyParameters,
    ParameterError,
    SensorParameters,
    check_int,
    check_real,
    drawn_lines,
)
from talbot.pixels.circuits.amplifier import GAIN, UNITS
from talbot.pixels.circuits.amplifier import UNIT as CELL
from talbot.pixels.circuits.specification import LaneSpec, one_digit

# Roles and lengths (um): inputs of the charge amplifier and of the holder, which drives the lane; cascodes, sources
FRONT, LANE, CASCODE = ("n", 2.0), ("n", 0.5), ("n_lvt", 0.5)
TOP, CASCODE_P, LANE_TOP = ("p", 3.3), ("p", 0.5), ("p", 0.5)
BACK_TOP = ("p", 6.0)  # its threshold is in the sample as the input's is, which has a third of the source's area
EFFICIENCY = {"front": 22.0, "back": 22.0, "lane": 17.0, "cascode": 15.0, "cascode_p": 15.0, "lane_p": 11.0}
# Of the sources: those of charge amplifiers and holders are one finger, as the bias's that they follow. In two of half
# the width one had 1.25 times the current at ff_125C_1v98, as drawn: SKY130's narrow transistors have more
EFFICIENCY |= {"top": 8.0, "lane_top": 9.0}
PARTS = 16  # of a lane's source of current, each the bias's transistor: one of all widths has 0.7 of their current
TIMES = 2.0  # Cin over Chold: the holder's gain
EXPOSED = 0.015  # of a charge that the signal half may leave at the typical corner
# More of a charge is lost, as measured there, on the mean of the taps: 0.0023 in the first, less in those after it, in
# whose reads the second diode's holder takes no charge
BEYOND = 0.0005
ACROSS = 0.14e-15  # F, of transistors across Cf
JUNCTIONS = 9e-15  # F, of a column that is not selected, at its lane's line
LEFT = 0.4  # of a limit, at the typical corner: others are slower
UNLIKE = 0.5  # of the offset's limit that is left to the charge amplifiers' inputs


@dataclass(frozen=True)
class ColumnSpec:
    """The specification of a column, in LSB of the lane's converter unless stated otherwise.

    Attributes
    ----------
    full_well : float
        Electrons of a diode, 100..1e9.
    fall : float
        V by which a full well falls, 0.01..0.7.
    swing : float
        V by which the lane's line falls for it, 0.01..1.2: what the lane's amplifier makes the sensor's gain of.
    dark : float
        V of the lane's line without light, 0.5..1.6.
    line : float
        F of a column line, 1e-15..1e-10.
    cycle : float
        S of the chip's clock, 1e-9..1e-3.
    settle, read : int
        Cycles of the reference half and of the signal half, 4..65535.
    wire, ohm : float
        Of a lane's line along the block, 1e-16..1e-10 F, 1..1e5 ohm.
    input : float
        F of the lane's amplifier at it, 1e-15..1e-10.
    columns, array : int
        At a lane's line, and in all, 1..10000.
    ready : float
        S from the select until the line is within ``settling``: what the lane's amplifier leaves of the cycle.
    settling : float
        LSB that may be left then.
    slope : float
        Relative, by which a charge's volts may be off, over that of the capacitors: common to all columns.
    inl : float
        LSB, peak, over four fifths of a full well, which are 408 LSB.
    noise : float
        Electrons, rms, of a diode: the light's own at half a full well.
    offset : float
        LSB, rms over columns, of a difference.
    wait : float
        S from the sample to the last column's turn.
    droop : float
        LSB that may be lost until then: the same of every row, and at 125 degrees alone.
    energy : float
        J a pixel that is read: Table 6.1's pixel array, which takes no other current here.
    pixel : float
        S a pixel at the table's frame rate: the bias's share.
    """

    full_well: float = 1e5
    fall: float = 0.5
    swing: float = DIODE * 4 * LaneSpec().lsb / GAIN
    dark: float = 1.2
    line: float = 0.8e-12
    cycle: float = 100e-9
    settle: int = 16
    read: int = 16
    wire: float = 0.7e-12
    ohm: float = 1200.0
    input: float = UNITS * CELL
    columns: int = 48
    array: int = 384
    ready: float = 50e-9
    settling: float = 0.5
    slope: float = 0.05
    inl: float = 1.0
    noise: float = 224.0
    offset: float = 4.0
    wait: float = 50e-6
    droop: float = 4.0
    energy: float = 70e-12
    pixel: float = 226e-9

    def __post_init__(self) -> None:
        check_real("full_well", self.full_well, 100, 1e9)
        check_real("fall", self.fall, 0.01, 0.7)
        check_real("swing", self.swing, 0.01, 1.2)
        check_real("dark", self.dark, 0.5, 1.6)
        for name in ("line", "wire", "input"):
            check_real(name, getattr(self, name), 1e-16, 1e-10)
        check_real("cycle", self.cycle, 1e-9, 1e-3)
        check_int("settle", self.settle, 4, 65535)
        check_int("read", self.read, 4, 65535)
        check_real("ohm", self.ohm, 1, 1e5)
        check_int("columns", self.columns, 1, 10_000)
        check_int("array", self.array, 1, 10_000)
        check_real("ready", self.ready, 1e-9, self.cycle)
        for name in ("settling", "inl", "droop"):
            check_real(name, getattr(self, name), 0.01, 16)
        check_real("offset", self.offset, 0.01, 64)
        check_real("slope", self.slope, 1e-4, 0.5)
        check_real("noise", self.noise, 1, 1e6)
        check_real("wait", self.wait, 1e-7, 1.0)
        check_real("energy", self.energy, 1e-15, 1e-6)
        check_real("pixel", self.pixel, 1e-9, 1.0)

    @classmethod
    def of(
        cls,
        sensor: SensorParameters | None = None,
        energy: EnergyParameters | None = None,
        timing: AmpTiming | None = None,
    ) -> Self:
        """Return the specification for a sensor: its lines and full well, the chip's clock and lanes, Table 6.1."""
        sensor, energy, timing = sensor or SensorParameters(), energy or EnergyParameters(), timing or AmpTiming()
        array, chip = sensor.array, sensor.chip
        drawn = drawn_lines(array.pitch_um)
        columns = ceil(array.cols / chip.lanes)
        rate = energy.frame_rate * energy.pixels
        return cls(
            full_well=sensor.electrical.full_well,
            swing=DIODE * sensor.electrical.difference_gain * LaneSpec().lsb / GAIN,
            line=array.rows * drawn.column_farad,
            cycle=1 / chip.f_clk,
            settle=timing.t_settle,
            read=timing.t_read,
            wire=array.cols * drawn.row_farad,
            ohm=array.cols * drawn.row_ohm / 2,  # a line of twice the width
            columns=columns,
            array=array.cols,
            noise=(sensor.electrical.full_well / 2) ** 0.5,
            wait=columns * 10 / chip.f_clk,
            energy=one_digit(energy.pixel_array / rate),
            pixel=1 / rate,
        )

    @classmethod
    def of_drawn(cls, sensor: SensorParameters) -> Self:
        """Return the specification for a sensor whose columns have the sizes of the standard sensor's.

        Raises ParameterError for lines with more capacitance than those sizes are for.
        """
        spec, standard, array = cls.of(sensor), cls.of(), sensor.array
        lines = ("rows", array.rows, spec.line, standard.line), ("cols", array.cols, spec.wire, standard.wire)
        for name, count, farad, most in lines:
            if farad > most * (1 + 1e-9):
                raise ParameterError(
                    f"array.{name} = {count}: must be at most {int(count * most / farad)} at array.pitch = "
                    f"{array.pitch:g}, for a line of {1e12 * most:.2f} pF, which the drawn columns are sized for"
                )
        return spec

    @property
    def well(self) -> float:
        """Capacitance of a well, F."""
        return self.full_well * ELEMENTARY_CHARGE / self.fall

    @property
    def lsb(self) -> float:
        """Voltage of the lane's line for an LSB of its converter, V."""
        return LaneSpec().lsb / GAIN


@dataclass(frozen=True)
class Stage:
    """A cascoded transistor with a cascoded source of current: A, and widths in um."""

    current: float
    input: float
    cascode: float
    top: float
    cascode_p: float

    def __post_init__(self) -> None:
        check_real("current", self.current, 1e-8, 1e-3)
        for name in ("input", "cascode", "top", "cascode_p"):
            check_real(name, getattr(self, name), 0.42, 100)


@dataclass(frozen=True)
class ColumnSizes:
    """Sizes of a diode's part of a column, and of the block's bias.

    front: the charge amplifier.
    back: the holder while a row is read.
    lane: the holder while its column is selected, with the lane's current source.
    feedback: F, Cf.
    hold: F, Chold.
    kick: F.
    gain: Cin over Chold.
    """

    front: Stage
    back: Stage
    lane: Stage
    feedback: float
    hold: float
    kick: float
    gain: float

    def __post_init__(self) -> None:
        for name in ("feedback", "hold", "kick"):
            check_real(name, getattr(self, name), 1e-16, 1e-11)
        check_real("gain", self.gain, 0.1, 16)

    @property
    def follows(self) -> float:
        """Volts of the lane's line for a volt of start: the capacitor that rises to start takes a part."""
        return 1 - self.kick / self.hold


HOLD = 0.14e-12  # F: a square of 8.2 um of MIM, as the pitch has room for
HOLDER = 8.0  # times a charge amplifier's speed: a holder's
KICK = 0.33  # of Chold: with it start is near dark at the typical corner
FINGER = 2.6  # um, of a transistor drawn on the pitch of a column
SLACK = 20e-9  # s of the signal half until the row's line is up
WAKE = 8e-9  # s of a column's turn until its transistors conduct


def source_of(name: str) -> str:
    """Return the name in EFFICIENCY of a stage's source of current."""
    return "lane_top" if name == "lane" else "top"


def size(spec: ColumnSpec, process: ModuleType, hold: float = HOLD) -> ColumnSizes:
    """Sizes for ``spec`` from the process's tables of gm/Id.

    The charge amplifier has the signal half to come within EXPOSED of the charge, the holder is HOLDER times as
    fast, and a selected one has its lane settled to LEFT of the settling's limit when it must be ready. What the charge
    amplifiers' thresholds differ by is the wells' level against their lines': by it their inputs are UNLIKE of the
    offset's limit. Cf is the well's size less what finite gain and time take.
    """
    front, drive = process.operating(*FRONT, EFFICIENCY["front"]), process.operating(*LANE, EFFICIENCY["lane"])
    cin, half = TIMES * hold, spec.read * spec.cycle - SLACK
    constants = log(1 / EXPOSED)
    unlike = process.AREA[FRONT[0]] * 1e-3 * spec.swing / spec.fall * 2**0.5 / (UNLIKE * spec.offset * spec.lsb)
    gm, beta, width, wide = 0.0, 0.0, 10.0, unlike**2 / FRONT[1]
    for _ in range(20):
        beta = spec.well / (spec.line + 2 * spec.well + width * front.gate)
        gm = (1.25 * cin + spec.well) / beta * constants / half
        width = max(gm / EFFICIENCY["front"] / front.density, wide)
    lane_gm, gate = 0.0, 0.0
    load = 2 * spec.wire + spec.input + spec.columns * JUNCTIONS
    for _ in range(20):
        time_constants = log(spec.swing / (LEFT * spec.settling * spec.lsb))
        lane_gm = load * (hold * (1 + KICK) + gate) / hold * time_constants / (spec.ready - WAKE)
        gate = lane_gm / EFFICIENCY["lane"] / drive.density * drive.gate
    back_beta = hold / (hold * (1 + KICK) + cin + gate)
    back_gm = HOLDER * constants / half * hold / back_beta

    def stage(kind: tuple[str, float], name: str, top: tuple[str, float], gm: float, least: float = 0.0) -> Stage:
        amperes = gm / EFFICIENCY[name]

        def width(kind: tuple[str, float], role: str) -> float:
            return amperes / process.operating(*kind, EFFICIENCY[role]).density

        widths = drawn(max(width(kind, name), least)), drawn(width(CASCODE, "cascode"))
        source, above = width(top, source_of(name)), width(CASCODE_P, "lane_p" if name == "lane" else "cascode_p")
        if name == "lane":
            return Stage(amperes, *widths, *(round(PARTS * drawn(w / PARTS), 2) for w in (source, above)))
        return Stage(amperes, *widths, alone(source), drawn(above))

    def gain(kind: tuple[str, float], name: str, top: tuple[str, float]) -> float:
        below = process.operating(*kind, EFFICIENCY[name]).gain
        below *= process.operating(*CASCODE, EFFICIENCY["cascode"]).gain
        source = EFFICIENCY[source_of(name)]
        above = process.operating(*top, source).gain
        above *= process.operating(*CASCODE_P, EFFICIENCY["cascode_p"]).gain
        return 1 / (1 / below + source / EFFICIENCY[name] / above)

    lost = EXPOSED + BEYOND + 1 / (beta * gain(FRONT, "front", TOP))
    lost += 1 / (back_beta * gain(LANE, "back", BACK_TOP))
    lost += (hold * (1 + KICK) + gate) / hold / gain(LANE, "lane", LANE_TOP)
    lane = stage(LANE, "lane", LANE_TOP, lane_gm)
    return ColumnSizes(
        stage(FRONT, "front", TOP, gm, wide),
        replace(stage(LANE, "back", BACK_TOP, back_gm), input=lane.input),
        lane,
        spec.well * TIMES * spec.fall / spec.swing * (1 - lost) - ACROSS,
        hold,
        KICK * hold,
        TIMES,
    )


def alone(width: float) -> float:
    """The nearest width (um) of a transistor that is one finger; one above FINGER fits no column that is drawn."""
    return round(max(0.42, width), 2)


def drawn(width: float) -> float:
    """Return the nearest width (um) of equal fingers: one below 2 um, else an even number of at most FINGER."""
    fingers = 1 if width < 2 else 2 * ceil(width / FINGER / 2)
    return round(max(0.42, round(width / fingers, 2)) * fingers, 2)
