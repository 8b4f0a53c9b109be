"""Electrostatic discharges into a pad, simulated with the clamps of its segment.

Human body [JS001]: 100 pF through 1500 ohm and 7.5 uH. Charged device [JS002]: the die's 10 pF through 10 nH and 25
ohm, a peak of 9 A at 500 V. The pad is stressed against the ground or the pads' supply; other pins are open.
"""

import itertools
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from talbot.pixels.pixel_circuit.deck import analyse
from talbot.platforms.pads import PadProcess

GROUND, SUPPLY, CORE = "vss", "iovdd", "vdd"
CORE_PF = 100.0  # between the core's supply and the ground
HOT = 100.0  # degree Celsius
RISE = 10e-6  # s
RIPPLE, PERIOD, EDGE, PERIODS = 0.1, 100e-9, 1e-9, 20  # V from peak to peak of a square wave; s; s; number simulated
ROOM, OPTIONS = 25.0, ".option gmin=1e-12 method=gear reltol=1e-3 itl4=200 temp={:g}"  # degree Celsius


@dataclass(frozen=True)
class Pulse:
    """A capacitor of ``farad`` charged to ``volts`` that discharges through ``henry`` and ``ohm``; stop: s."""

    name: str
    volts: float
    farad: float
    henry: float
    ohm: float
    stop: float


HBM = Pulse("HBM", 2000.0, 100e-12, 7.5e-6, 1500.0, 300e-9)
CDM = Pulse("CDM", 500.0, 10e-12, 10e-9, 25.0, 10e-9)


class Quiet(NamedTuple):
    """Currents of the core's supply into its pad in operation, A.

    leak: at rest. rise: the largest while the supply rises within RISE, ripple: the mean under RIPPLE, both with that
    of the capacitances.
    """

    leak: float
    rise: float
    ripple: float


class Stress(NamedTuple):
    """Largest current, A, and voltages against the ground, V: of the pad, of the pads' supply, of the core's.

    volts: of the pulse; to: the net that is grounded.
    """

    cell: str
    pulse: str
    volts: float
    to: str
    ampere: float
    pad: float
    supply: float
    core: float


def cases(process: PadProcess) -> Iterator[tuple[str, str, Pulse, str, int]]:
    """Arguments of `stress` between ``process`` and ``clamps``: each signal's pad, the core's supply, the pads'."""
    cells = dict.fromkeys(process.signals.values(), "pad") | {process.supplies[pin]: pin for pin in (CORE, SUPPLY)}
    for (cell, pin), pulse, to, sign in itertools.product(cells.items(), (HBM, CDM), (GROUND, SUPPLY), (1, -1)):
        if pin != to:
            yield cell, pin, pulse, to, sign


def stress(
    lines: Sequence[str],
    process: PadProcess,
    cell: str,
    pin: str,
    pulse: Pulse,
    to: str,
    sign: int,
    clamps: int,
    cores: int = 0,
) -> Stress:
    """Simulate one pulse. lines: of models and pads. to: the net that is grounded. sign: of the charge.

    clamps, cores: other pads in the segment, of the pads' supply and of the core's.
    """
    on: Mapping[str, str] = {to: "0"}
    ground, supply, core = (on.get(net, net) for net in (GROUND, SUPPLY, CORE))
    deck = [*lines, OPTIONS.format(ROOM), _pad(lines, cell, on)]
    for net, count in ((SUPPLY, clamps), (CORE, cores)):
        deck += [f"X{net}_{k} {ground} {core} {supply} {process.supplies[net]}" for k in range(count)]
    deck += [
        f"Ccore {core} {ground} {CORE_PF:g}p",
        f"Cstart start 0 {pulse.farad:g} ic={sign * pulse.volts:g}",
        "Sstart start on close 0 switch",
        ".model switch sw vt=0.5 ron=0.1 roff=1e12",
        f"Vclose close 0 pwl(0 0 {pulse.stop / 1000:g} 0 {pulse.stop / 500:g} 1)",
        f"Lpath on path {pulse.henry:g}",
        f"Rpath path into {pulse.ohm:g}",
        f"Vpath into {pin} 0",
    ]

    def across(net: str) -> str:
        return f"v({net})" if ground == "0" else f"v({net})-v({ground})" if net != "0" else f"0-v({ground})"

    vectors = ["i(vpath)", *(across(on.get(net, net)) for net in (pin, SUPPLY, CORE))]
    step = pulse.stop / 1000
    waves = analyse(deck, [f"tran {step:g} {pulse.stop:g} 0 {step:g} uic"], vectors)
    peaks = [float(abs(wave).max()) for wave in waves]
    return Stress(cell, pulse.name, sign * pulse.volts, to, *peaks)


def _pad(lines: Sequence[str], cell: str, on: Mapping[str, str]) -> str:
    """Return the pad as an instance. on: port -> net, of ports on a net of another name."""
    ports = next(line for line in lines if line.startswith(f".subckt {cell} ")).split()[2:]
    return f"Xpad {' '.join(on.get(port, port) for port in ports)} {cell}"


def quiet(leaky: Sequence[str], fast: Sequence[str], process: PadProcess) -> Quiet:
    """Simulate the core's pad in operation at HOT. leaky, fast: lines of models and pads, for leak and the others."""
    high, half = process.core_v, PERIOD / 2
    (leak,) = _supplied(leaky, process, f"{high}", "op", "i(vcore)")
    (rise,) = _supplied(
        fast, process, f"pwl(0 0 {RISE:g} {high})", f"tran {RISE / 500:g} {1.5 * RISE:g} 0 {RISE / 500:g}", "i(vcore)"
    )
    wave = f"pulse({high - RIPPLE / 2} {high + RIPPLE / 2} {half:g} {EDGE:g} {EDGE:g} {half - EDGE:g} {PERIOD:g})"
    begin, end = PERIODS / 2 * PERIOD, PERIODS * PERIOD
    (charge,) = _supplied(fast, process, wave, f"tran {PERIOD / 100:g} {end:g} {begin:g} {PERIOD / 100:g}", "v(charge)")
    return Quiet(abs(float(leak[-1])), float(abs(rise).max()), float(charge[-1] - charge[0]) * 1e-12 / (end - begin))


def _supplied(lines: Sequence[str], process: PadProcess, core: str, analysis: str, vector: str) -> Any:
    """Return a vector of the core's pad at HOT. core: value of its source; v(charge): what it gave, pC."""
    deck = [
        *lines,
        OPTIONS.format(HOT),
        _pad(lines, process.supplies[CORE], {GROUND: "0", CORE: "core", SUPPLY: "pads"}),
        f"Vpads pads 0 {process.pad_v}",
        f"Vcore core 0 {core}",
        "Fcharge charge 0 Vcore 1",
        "Ccharge charge 0 1p",
        "Rcharge charge 0 1e12",
        ".ic v(charge)=0",
    ]
    return analyse(deck, [analysis], [vector])
