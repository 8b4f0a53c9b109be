"""A circuit in ngspice at a corner: models, supplies, references behind their resistance; clocked waveforms."""

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from types import ModuleType

import numpy as np
import numpy.typing as npt

from talbot.cells.corner import Corner
from talbot.cells.spice.engine import Points, Simulator
from talbot.cells.spice.settings import Settings
from talbot.cells.spice.wave import Wave
from talbot.models.parameters import check_choice
from talbot.pixels.circuits.netlist import Circuit
from talbot.pixels.circuits.specification import LaneSpec
from talbot.platforms.sky130 import analog as sky130

EDGE = 100e-12  # s, of clock and bits
CLOCK_TO_Q = 1e-9  # s from a clock's edge to the chip's outputs
SETTINGS = Settings(timeout=300)
PROCESSES = {"sky130": sky130}


def process_of(name: str) -> ModuleType:
    """Return the process of this name for analog circuits. Raises ParameterError."""
    check_choice("pdk", name, PROCESSES)
    return PROCESSES[name]


@dataclass(frozen=True)
class Setup:
    """Process, specification and spread of unit capacitors (low, high), common to all runs."""

    pdk: str
    spec: LaneSpec
    spread: tuple[float, float] = (1.0, 1.0)

    def scale(self, corner: Corner) -> float:
        """Factor of the capacitors at a corner: large where transistors are slow, small where they are fast."""
        return self.spread[1] if corner.process == "ss" else self.spread[0] if corner.process == "ff" else 1.0


def deck(
    circuit: Circuit,
    setup: Setup,
    corner: Corner,
    copies: Sequence[Sequence[str]] = (),
    seed: int | None = None,
    alike: Collection[str] = (),
) -> list[str]:
    """Models, subcircuits and instances. copies: the nodes of each instance; without, one whose nodes are its ports.

    seed: mismatch of every transistor is drawn with it, but of the roles in ``alike``. Raises ParameterError for a
    broken circuit, before anything runs.
    """
    process = process_of(setup.pdk)
    circuit.check(process)
    lines = [] if seed is None else [f".option seed={seed}"]
    lines += process.cards(corner.process, circuit.sizes(), seed is not None, alike)
    scales = (
        f".param cscale={setup.scale(corner):.6g} rscale={process.resistance(corner.process, corner.temperature):.6g}"
    )
    lines += [scales, *circuit.lines(process)]
    if not copies:
        return [*lines, f"Xcell {' '.join(circuit.ports)} {circuit.name}"]
    return [*lines, *(f"Xc{k} {' '.join(nodes)} {circuit.name}" for k, nodes in enumerate(copies))]


def references(spec: LaneSpec) -> tuple[list[str], dict[str, float]]:
    """Resistors of a deck, and the rails (V) behind them: refp, refn, vcm."""
    levels = {"refp": spec.refp, "refn": spec.refn, "vcm": spec.vcm}
    lines = [f"Rx{name} {name}_ext {name} {max(spec.reference_resistance, 1e-3):g}" for name in levels]
    return lines, {f"{name}_ext": volts for name, volts in levels.items()}


def simulator(
    lines: Iterable[str],
    inputs: Iterable[str],
    outputs: Iterable[str],
    corner: Corner,
    rails: Mapping[str, float] | None = None,
    settings: Settings = SETTINGS,
) -> Simulator:
    """Return an ngspice process of a deck with the supplies vdd and vss."""
    all_rails = {"vdd": corner.supply, "vss": 0.0, **(rails or {})}
    return Simulator(lines, inputs, outputs, all_rails, corner.temperature, settings)


def bits(values: Sequence[int | bool], period: float, high: float) -> Points:
    """Return a signal that has ``values`` in consecutive periods, each CLOCK_TO_Q late."""
    points = [(0.0, high * bool(values[0]))]
    for k, (before, after) in enumerate(zip(values, values[1:], strict=False), 1):
        if before != after:
            change = k * period + CLOCK_TO_Q
            points += [(change, high * bool(before)), (change + EDGE, high * bool(after))]
    return points


def clock(periods: int, period: float, high: float, phase: float = 0.5) -> Points:
    """High from ``phase`` of each period to its end."""
    points = [(0.0, 0.0)]
    for k in range(periods):
        up, down = (k + phase) * period, (k + 1) * period
        points += [(up, 0.0), (up + EDGE, high), (down, high), (down + EDGE, 0.0)]
    return points


def settling(wave: Wave, node: str, begin: float, rest: float, within: float) -> float:
    """Return the time after ``begin``, s, from which a node stays ``within`` V of its value at ``rest`` (s)."""
    return settled(wave.time, wave.voltage[node] - wave.at(node, rest), begin, rest, within)


def settled(
    time: npt.NDArray[np.float64], off: npt.NDArray[np.float64], begin: float, end: float, within: float
) -> float:
    """Return the time after ``begin``, s, from which, until ``end``, the error ``off`` stays ``within`` V."""
    inside = (time > begin) & (time < end)
    return float(time[inside][np.abs(off[inside]) > within].max(initial=begin) - begin)


def patient(seconds: float) -> Settings:
    """Return SETTINGS with this limit of CPU seconds for a transient."""
    return replace(SETTINGS, timeout=seconds)
