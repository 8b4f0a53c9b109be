"""Energy of an event: the measured power of the thesis's sensor [Jayasuriya2017, Table 6.1], the layout's gates."""

from dataclasses import dataclass, fields
from typing import NamedTuple

from talbot.models.parameters.checks import check_real
from talbot.models.parameters.electrical import ELEMENTARY_CHARGE, PHOTON
from talbot.models.parameters.sources import sourced

TABLE = "[Jayasuriya2017], Table 6.1"
LAYOUT = "flow/layout, tt, 1.8 V: make layout-energy of commit bbb7078d"
CIRCUITS = "make analog, tt_027C_1v80: pixels/datasheet"
DECISIONS = 8  # comparator decisions of one full conversion
WINDOW = 2  # of the window comparison


class DigitalEvents(NamedTuple):
    """Events of the digital part in a frame.

    Attributes
    ----------
    cycles : int
        Of the clock while the chip is busy.
    rows : int
        Rows read.
    samples : int
        Samples that the converters gave.
    decisions : int
        Comparator decisions.
    bytes : int
        Of the stream.
    divisions : int
        Of the phases.
    """

    cycles: int = 0
    rows: int = 0
    samples: int = 0
    decisions: int = 0
    bytes: int = 0
    divisions: int = 0


class Events(NamedTuple):
    """Events of a frame.

    Attributes
    ----------
    resets : int
        Pixels reset and integrated: whole rows, once per tap.
    amplified : int
        Pixels whose column amplifier ran.
    seconds : float
        Duration of the frame.
    decisions : int
        Comparator decisions, window and search together.
    toggles : int
        Changes of the stream's output pins.
    digital : DigitalEvents
        What it made the digital part do.
    pulses : int
        Of the rows' lines.
    strobes : int
        Of the comparators.
    """

    resets: int
    amplified: int
    seconds: float
    decisions: int
    toggles: int
    digital: DigitalEvents = DigitalEvents()
    pulses: int = 0
    strobes: int = 0


@dataclass(frozen=True)
class CircuitEnergy:
    """Energy of an event by the circuits in ngspice, 0..1 J each; the amplifiers wake by the chip's pin.

    Attributes
    ----------
    pulse : float
        Of a row's line.
    pixel : float
        Column amplifiers of both diodes: read, turn and their share of the bias.
    sample : float
        A lane's amplifier: waking, sample, and what flows until the next.
    decision : float
        Comparator, capacitors and references.
    strobe : float
        A lane's line of inverters, in each cycle that converts.
    idle : float
        Comparator alone, strobed without a decision that counts.
    """

    pulse: float = sourced(63.6e-12, CIRCUITS, "J")
    pixel: float = sourced(56.1e-12, CIRCUITS, "J")
    sample: float = sourced(150e-12, CIRCUITS, "J")
    decision: float = sourced(2.02e-12, CIRCUITS, "J")
    strobe: float = sourced(0.555e-12, CIRCUITS, "J")
    idle: float = sourced(1.0e-12, CIRCUITS, "J")

    def __post_init__(self) -> None:
        for item in fields(self):
            check_real(item.name, getattr(self, item.name), 0, 1)

    def frame(self, events: Events) -> dict[str, float]:
        """Energy of the analog parts in one frame.

        events: what the frame did; the columns of pixels that are left out run, too. Returns part to energy in J.
        """
        idle = max(events.strobes - events.decisions, 0)
        return {
            "rows": self.pulse * events.pulses,
            "columns": self.pixel * events.resets,
            "amplifiers": self.sample * events.digital.samples,
            "converters": self.decision * events.decisions + self.strobe * events.strobes + self.idle * idle,
        }


@dataclass(frozen=True)
class EnergyParameters:
    """Measured power of a sensor by part, and what it takes to make energies of it.

    The converters' power may be that of converting every sample, or already that of converting edges alone: Table 6.1
    does not say. `frame` gives both readings. The digital part has two sources, of which a total takes one: ``timing``
    of the table, and the switching energy at the gates of the layout, event by event (without its outputs' loads).

    Attributes
    ----------
    pixel_array, amplifiers, timing, adcs : float
        Power of each part, 0..1 W.
    frame_rate : float
        0.1..1e5 frames per second.
    pixels : float
        Pixels of the measured sensor, 1..2**31.
    edge_share : float
        Fraction of samples converted where the converters' power is that of edges alone, 0..1.
    pad_load : float
        Capacitance at an output pin, 0..1e-9 F.
    pad_voltage : float
        0.1..10 V.
    cycle, row, sample, decision, byte, division : float
        Switching energy of the digital part, 0..1 J each of `DigitalEvents`.
    glitches : float
        Factor to these, which are without glitches, 1..10.
    leakage : float
        Power of the digital part's gates at rest, 0..1 W.

    References
    ----------
    [Jayasuriya2017], Table 6.1.
    """

    pixel_array: float = sourced(300e-6, TABLE, "W")
    amplifiers: float = sourced(900e-6, TABLE, "W")
    timing: float = sourced(500e-6, TABLE, "W")
    adcs: float = sourced(100e-6, TABLE, "W")
    frame_rate: float = sourced(30.0, "assumed: the table has none", "Hz")
    pixels: float = sourced(384 * 384, TABLE)
    edge_share: float = sourced(0.1, "[Jayasuriya2017], Sec. 6.3: 120 of 1200 kbit")
    pad_load: float = sourced(10e-12, "assumed", "F")
    pad_voltage: float = sourced(1.8, "assumed", "V")
    cycle: float = sourced(28.31e-12, LAYOUT, "J")
    row: float = sourced(279.1e-12, LAYOUT, "J")
    sample: float = sourced(14.44e-12, LAYOUT, "J")
    decision: float = sourced(3.19e-12, LAYOUT, "J")
    byte: float = sourced(0.0, LAYOUT, "J")
    division: float = sourced(6.652e-12, LAYOUT, "J")
    glitches: float = sourced(1.004, LAYOUT)
    leakage: float = sourced(1.49e-6, LAYOUT, "W")

    def __post_init__(self) -> None:
        ends = {"frame_rate": (0.1, 1e5), "pixels": (1, 2**31), "pad_load": (0, 1e-9), "pad_voltage": (0.1, 10)}
        ends["glitches"] = (1, 10)
        for item in fields(self):
            check_real(item.name, getattr(self, item.name), *ends.get(item.name, (0, 1)))

    def frame(self, events: Events) -> dict[str, tuple[float, float]]:
        """Energy of one frame by part, in both readings of the converters' power.

        events: what the frame did. Returns part to energy in J: lower reading (every sample was converted), higher
        (edges alone were). ``timing`` and ``digital`` are two sources for one part.
        """
        each = 1 / (self.frame_rate * self.pixels)
        every = self.adcs * each / DECISIONS * events.decisions
        edges = self.adcs * each / (WINDOW + self.edge_share * DECISIONS) * events.decisions
        known = {
            "pixel_array": self.pixel_array * each * events.resets,
            "amplifiers": self.amplifiers * each * events.amplified,
            "timing": self.timing * events.seconds,
            "digital": self.switched(events.digital) + self.leakage * events.seconds,
            "pads": self.pad_load * self.pad_voltage**2 / 2 * events.toggles,
        }
        return {name: (value, value) for name, value in known.items()} | {"adcs": (every, edges)}

    def total(self, events: Events) -> tuple[float, float]:
        """Energy of one frame, from the lowest to the highest reading of every part.

        events: what the frame did. Returns (float, float): in J: the digital part is the smaller of its two sources in
        the first, the larger in the second.
        """
        parts = self.frame(events)
        both = parts.pop("timing")[0], parts.pop("digital")[0]
        low, high = (sum(values) for values in zip(*parts.values()))
        return low + min(both), high + max(both)

    def switched(self, events: DigitalEvents) -> float:
        """Switching energy of the digital part, glitches included.

        events: what it did. Returns float: in J.
        """
        each = self.cycle, self.row, self.sample, self.decision, self.byte, self.division
        return self.glitches * sum(energy * count for energy, count in zip(each, events, strict=True))


EYE_LIMIT = 100.0  # W/m^2 of infrared at an eye for more than 1000 s [IEC62471]


@dataclass(frozen=True)
class LightParameters:
    """The modulated light of time of flight, from the photocurrent of white back to the source.

    Attributes
    ----------
    quantum_efficiency : float
        Of the bare diode at the source's wavelength, 0.01..1.
    gratings : float
        What is left of it under the gratings, 0.01..1; in the light of a room, too.
    wavelength : float
        Of the source, 700e-9..1000e-9 m.
    fill : float
        Area of one diode over the pixel's, 0.01..0.5.
    transmission : float
        Of the lens, 0.01..1.
    efficiency : float
        Optical over electrical power of the source, 0.001..1.
    """

    quantum_efficiency: float = sourced(0.7, "assumed")
    gratings: float = sourced(0.5, "[Jayasuriya2017], Ch. 2: phase gratings, up to 50 % relative quantum efficiency")
    wavelength: float = sourced(850e-9, "assumed", "m")
    fill: float = sourced(0.4, "assumed")
    transmission: float = sourced(0.9, "assumed")
    efficiency: float = sourced(0.3, "assumed")

    def __post_init__(self) -> None:
        check_real("wavelength", self.wavelength, 700e-9, 1000e-9)
        low = {"quantum_efficiency": 0.01, "gratings": 0.01, "fill": 0.01, "transmission": 0.01, "efficiency": 0.001}
        for name, least in low.items():
            check_real(name, getattr(self, name), least, 0.5 if name == "fill" else 1)

    @property
    def responsivity(self) -> float:
        """Return the responsivity of a diode under its gratings, A/W."""
        return self.quantum_efficiency * self.gratings * ELEMENTARY_CHARGE * self.wavelength / PHOTON

    def field(self, white_current: float, pitch: float, nu_max: float) -> float:
        """Irradiance that the source gives a white field in the focal plane.

        white_current: photocurrent of one diode in A. pitch: of the pixels in m. nu_max: tangent of the lens's rim at
        the sensor, the angle theta: irradiance there is sin(theta)**2 times the transmission times the field's own,
        which is white. Returns float: in W/m^2.
        """
        sensor = white_current / (self.responsivity * self.fill * pitch**2)
        return sensor * (1 + nu_max**2) / (self.transmission * nu_max**2)

    def power(self, white_current: float, pitch: float, pixels: int, nu_max: float, magnification: float) -> float:
        """Return the electrical power of a source that lights exactly a white field in the focal plane.

        white_current, pitch: as in `field`. pixels: of the array. nu_max: as in `field`. magnification: of the lens.
        Returns float: in W.
        """
        return self.field(white_current, pitch, nu_max) * pixels * (pitch / magnification) ** 2 / self.efficiency
