"""The converter lane: whole conversions, levels of its DAC, settling, droop, energy, at one corner."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from talbot.cells.corner import Corner
from talbot.cells.spice.engine import Simulator
from talbot.cells.spice.wave import Wave
from talbot.models.digital.sar import decisions as search
from talbot.models.parameters import ParameterError
from talbot.pixels.circuits.lane import PINS, LaneSizes, sar_lane
from talbot.pixels.circuits.netlist import Circuit
from talbot.pixels.datasheet.deck import Setup, bits, clock, deck, references, settled, simulator

BITS = 8
INPUTS = ("lane_a", "lane_b", "sample", "strobe", *(f"d{k}" for k in range(BITS)))
WATCHED = ("comparator", "xcell.top", "xcell.other")
LOAD = 5e-15  # F at the decision
CODES = (1, 255, 64, 192, 127, 128, 129)  # levels that are measured, from end to end so that a memory shows
VALUE = 100.3  # LSB, of the whole conversion
DROOP_CYCLES, DROOP_CODES = 8, 64
WRONG_WEIGHT = 0.2  # of a bit of one unit; less by the square root of the units of others
BISECTIONS, REACH = 6, 0.8  # LSB around a code's level within which its decision is sought: to 0.0125
SECOND = 2.0  # LSB: a second point at one level, which gives the gain at it


@dataclass(frozen=True)
class LaneResult:
    """A lane at one corner; all but energies and counts in LSB or s.

    levels: (code, level - (code - 0.5)), by the plates before the strobe; decided: by the decisions, in the order of
    CODES, +-REACH where it is beyond. gain: volts at the comparator for a volt at the input. settling: s until the
    comparator's input is within half an LSB. droop: LSB in a conversion, DROOP_CODES away from balance. code: of the
    conversion of VALUE; passes: transients until its decisions agreed with the codes that were put in. energy: J a
    decision of supply and references.
    """

    levels: list[tuple[int, float]]
    decided: list[tuple[int, float]]
    gain: float
    settling: float
    droop: float
    code: int
    passes: int
    energy: dict[str, float]
    runs: int
    repeated: int


def open_lane(setup: Setup, sizes: LaneSizes, corner: Corner, circuit: Circuit | None = None) -> Simulator:
    """Return an ngspice process of a lane with its references. circuit: instead of that of ``sizes``, with its pins."""
    circuit = circuit or sar_lane(sizes)
    if circuit.ports != PINS:
        raise ParameterError(f"circuit {circuit.name}: ports = {' '.join(circuit.ports)}: must be {' '.join(PINS)}")
    resistors, rails = references(setup.spec)
    return simulator([*deck(circuit, setup, corner), *resistors], INPUTS, WATCHED, corner, rails)


def run_codes(
    spice: Simulator, setup: Setup, values: Sequence[float], samples: Sequence[bool], codes: Sequence[int]
) -> Wave:
    """Run a transient: in each cycle the input (LSB above code 0), whether it is sampled, and the DAC's code."""
    spec, vdd = setup.spec, spice.rails["vdd"]
    period, count = 1 / spec.f_clk, len(codes)
    middle = (spec.refp + spec.refn) / 2
    volts = [spec.refn + value * spec.lsb for value in values]
    points = [(0.0, volts[0])]
    for k in range(1, count):
        if volts[k] != volts[k - 1]:
            points += [(k * period, volts[k - 1]), (k * period + 1e-9, volts[k])]
    stimulus = {
        "lane_a": points,
        "lane_b": [(0.0, middle)],
        "sample": bits(samples, period, vdd),
        "strobe": clock(count, period, vdd),
    }
    stimulus |= {f"d{k}": bits([code >> k & 1 for code in codes], period, vdd) for k in range(BITS)}
    return spice.transient(stimulus, {"comparator": LOAD}, count * period, period / 10)


def difference(wave: Wave, when: float) -> float:
    """Return the comparator's input voltages, V, positive where the code's level is reached."""
    return wave.at("xcell.other", when) - wave.at("xcell.top", when)


def convert(spice: Simulator, setup: Setup, value: float, passes: int = BITS + 1) -> tuple[int, int, Wave]:
    """Code of a value (LSB above code 0), transients that it took, and the last one's waves.

    The chip's search is `models/digital/sar.py`. A transient with the codes of assumed decisions shows the circuit's:
    from the first that differs the search goes on with it, until all agree: what a lock-step run gives.
    """
    period = 1 / setup.spec.f_clk
    assumed = [value >= code - 0.5 for code in codes_of(value)]
    for k in range(1, passes + 1):
        codes, code = _search(assumed)
        wave = run_codes(spice, setup, [value] * 9, [True] + [False] * 8, [codes[0], *codes])
        made = [wave.at("comparator", (n + 2) * period - 1e-10) > spice.rails["vdd"] / 2 for n in range(BITS)]
        if made == assumed:
            return code, k, wave
        first = next(n for n in range(BITS) if made[n] != assumed[n])
        assumed = [*assumed[:first], made[first], *made[first + 1 :]]
    raise ParameterError(f"conversion of {value:g} LSB: its decisions must be stable, they change in {passes} passes")


def _search(answers: Sequence[bool]) -> tuple[list[int], int]:
    """Return the codes of a search that gets these answers, and its result."""
    lane = search(True, 0)
    codes = [next(lane)]
    for answer in answers:
        try:
            codes.append(lane.send(answer))
        except StopIteration as end:
            return codes, end.value[0]
    raise AssertionError("a search has eight decisions")


def codes_of(value: float) -> list[int]:
    """Return the codes of an ideal search."""
    lane = search(True, 0)
    codes = [next(lane)]
    while len(codes) < BITS:
        codes.append(lane.send(value >= codes[-1] - 0.5))
    return codes


def measure(setup: Setup, sizes: LaneSizes, corner: Corner, circuit: Circuit | None = None) -> LaneResult:
    """Measure a lane at a corner."""
    period = 1 / setup.spec.f_clk
    with open_lane(setup, sizes, corner, circuit) as spice:
        held = [(192.0, 192 - DROOP_CODES)] * DROOP_CYCLES
        wave, levels, gain = _levels(spice, setup, CODES, held)
        lsb, after = gain * setup.spec.lsb, 2 * (len(CODES) + 1)
        strobes = [(2 * k + 1.5) * period for k in range(len(CODES) + 1)]
        settling = max(_settled(wave, when - period / 2, when, lsb / 2) for when in strobes)
        ends = [difference(wave, (after + n + 0.5) * period) for n in (1, DROOP_CYCLES)]
        droop = abs(ends[1] - ends[0]) / lsb * BITS / (DROOP_CYCLES - 1)
        decided = _decided(spice, setup, CODES)
        code, passes, wave = convert(spice, setup, VALUE)
        energy = {"supply": _energy(wave, "vdd", period, spice.rails["vdd"])}
        rails = {f"{name}_ext": getattr(setup.spec, name) for name in ("refp", "refn", "vcm")}
        energy["references"] = sum(_energy(wave, name, period, volts) for name, volts in rails.items())
        return LaneResult(levels, decided, gain, settling, droop, code, passes, energy, spice.runs, spice.repeated)


def _levels(
    spice: Simulator, setup: Setup, codes: Sequence[int], held: Sequence[tuple[float, int]] = ()
) -> tuple[Wave, list[tuple[int, float]], float]:
    """Wave, (code, level - (code - 0.5)) of each, and the gain up to the comparator.

    Each code has a cycle that samples its level and one that compares; before them one with SECOND LSB more. held:
    (value, code) of further cycles behind them, without a sample but at the first.
    """
    spec, period = setup.spec, 1 / setup.spec.f_clk
    points = [(codes[-1], codes[-1] - 0.5 + SECOND), *((code, code - 0.5) for code in codes)]
    values = [value for _, value in points for _ in range(2)] + [value for value, _ in held[:1]]
    samples = [True, False] * len(points) + [True] * bool(held) + [False] * len(held)
    put = [given for code, _ in points for given in (128, code)] + [128] * bool(held) + [code for _, code in held]
    wave = run_codes(spice, setup, values + [value for value, _ in held], samples, put)
    found = [difference(wave, (2 * k + 1.5) * period) for k in range(len(points))]
    gain = (found[0] - found[-1]) / (SECOND * spec.lsb)
    return wave, [(code, -volts / (gain * spec.lsb)) for code, volts in zip(codes, found[1:], strict=True)], gain


def _decided(spice: Simulator, setup: Setup, codes: Sequence[int]) -> list[tuple[int, float]]:
    """(code, level - (code - 0.5)) where the comparator's decision changes.

    The comparator kicks both plates as it decides, and what it makes of them need not be what is there before.
    """
    period, count = 1 / setup.spec.f_clk, len(codes)
    low, high = np.full(count, -REACH), np.full(count, REACH)
    for _ in range(BISECTIONS):
        middle = (low + high) / 2
        values = [code - 0.5 + off for code, off in zip(codes, middle, strict=True) for _ in range(2)]
        put = [given for code in codes for given in (128, code)]
        wave = run_codes(spice, setup, values, [True, False] * count, put)
        ends = (2 * np.arange(count) + 2) * period - 1e-10
        ones = np.array([wave.at("comparator", end) > spice.rails["vdd"] / 2 for end in ends])
        low, high = np.where(ones, low, middle), np.where(ones, middle, high)
    return [(code, float(off)) for code, off in zip(codes, (low + high) / 2, strict=True)]


def faults(setup: Setup, sizes: LaneSizes, corner: Corner, circuit: Circuit | None = None) -> list[str]:
    """Return the faults of a lane by part: the comparator's inputs, and the weight of every bit."""
    spec, found = setup.spec, []
    with open_lane(setup, sizes, corner, circuit) as spice:
        wave = run_codes(spice, setup, [192.0] * 2 + [64.0] * 2, [True, False] * 2, [128] * 4)
        for name, when, above in (("192", 1, True), ("64", 3, False)):
            at, end = (when + 0.5) / spec.f_clk, (when + 1) / spec.f_clk - 1e-10
            made = wave.at("comparator", end) > spice.rails["vdd"] / 2
            if (difference(wave, at) > 0) != above:
                found.append(f"lane: top and other plate: must be {'below' if above else 'above'} at {name}, swapped")
            elif made != above:
                found.append("comparator: inp and inn: must not be swapped")
        if found:
            return list(dict.fromkeys(found))
        powers = [1 << k for k in range(BITS)]
        _, errors, _ = _levels(spice, setup, powers)
    weights = np.array([(error + code) / code for code, error in errors])
    ratio = weights / np.median(weights)
    return [
        f"DAC: capacitor bit{k} = {ratio[k]:.2f} of its weight: must be 1"
        for k in range(BITS)
        if abs(ratio[k] - 1) > WRONG_WEIGHT / (1 << k) ** 0.5
    ]


def _settled(wave: Wave, start: float, end: float, within: float) -> float:
    """Return the time after ``start``, s, from which the comparator's input stays ``within`` V of its end."""
    volts = wave.voltage["xcell.other"] - wave.voltage["xcell.top"]
    return settled(wave.time, volts - difference(wave, end), start, end, within)


def _energy(wave: Wave, rail: str, period: float, volts: float) -> float:
    """Return the energy of a decision, J: an eighth of the charge from the first decision's cycle on."""
    return wave.charge(rail, period, (BITS + 1) * period) * volts / BITS


def inl(levels: Sequence[tuple[int, float]]) -> tuple[float, float, float]:
    """Return offset (at code 128), gain error (end to end), peak deviation from the line through the ends, LSB."""
    codes, errors = np.array(levels).T
    order = np.argsort(codes)
    codes, errors = codes[order], errors[order]
    slope = (errors[-1] - errors[0]) / (codes[-1] - codes[0])
    line = errors[0] + slope * (codes - codes[0])
    middle = float(np.interp(128, codes, line))
    return middle, float(slope * 255), float(np.abs(errors - line).max())
