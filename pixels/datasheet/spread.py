"""The amplifier's mismatch and noise: amplifiers drawn by the models, and `.noise` of both of its phases."""

import re
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from talbot.base.tools import ToolError, finish
from talbot.cells.corner import Corner
from talbot.pixels.circuits.amplifier import PICK, TRIM_BITS, UNITS, AmplifierSizes, AmplifierSpec, amplifier
from talbot.pixels.circuits.lane import LaneSizes
from talbot.pixels.circuits.netlist import Circuit
from talbot.pixels.datasheet.amplifier import END, LANE_OHM, REACH, biased, load_of, opened, sample
from talbot.pixels.datasheet.deck import SETTINGS, Setup, deck, process_of

BAND = "dec 5 1e5 1e10"  # Hz: what is slower, the reset takes away
LOOP = 1e9  # ohm, without noise: an operating point for an input that floats in the signal's phase
INNER = "xcell.xamplifier."
FRAME = 1 / 3  # of REACH: differences that a drawn amplifier gets


@dataclass(frozen=True)
class Drawn:
    """One amplifier with mismatch. offset: LSB; gain: over the capacitors' nominal one."""

    offset: float
    gain: float


@dataclass(frozen=True)
class AmplifierNoise:
    """Rms at the lane, LSB. reset: what its end leaves on both inputs. signal: of the amplifier, as the lane samples.

    closed: kT/C of both inputs, without the amplifier.
    """

    reset: float
    signal: float
    closed: float

    @property
    def total(self) -> float:
        """Both."""
        return float(np.hypot(self.reset, self.signal))


def drawn(
    setup: Setup, spec: AmplifierSpec, sizes: AmplifierSizes, lane: LaneSizes, corner: Corner, seed: int
) -> Drawn:
    """Return one amplifier: transistors with the models' mismatch, capacitors with that of their cells."""
    lsb, load = setup.spec.lsb, load_of(setup, lane, corner)
    level = REACH * FRAME * 128 * lsb / sizes.gain
    circuit = with_mismatch(amplifier(sizes), sizes, process_of(setup.pdk).CELL_MISMATCH, seed)
    out = []
    with opened(setup, spec, circuit, corner, seed) as spice:
        for a, b in ((2 * level, level), (level, 2 * level)):
            wave = sample(spice, spec, corner, load, a, b, UNITS, spec.vref, until=END)
            out.append((wave.at("lane", END * spec.hold) - spec.vref) / lsb)
    return Drawn(sum(out) / 2, (out[0] - out[1]) / 2 / (level * sizes.gain / lsb))


def with_mismatch(circuit: Circuit, sizes: AmplifierSizes, cell: float, seed: int) -> Circuit:
    """The same amplifier, each capacitor off by ``cell`` (rms, relative, of one cell) over the root of its cells."""
    rng = np.random.default_rng((seed, 3))
    cells = sizes.cells
    values = {
        c.name: c.value * (1 + cell / np.sqrt(cells * c.units) * rng.standard_normal()) for c in circuit.capacitors
    }
    return circuit.with_capacitors({name: float(value) for name, value in values.items()})


def noise(
    setup: Setup, spec: AmplifierSpec, sizes: AmplifierSizes, lane: LaneSizes, corner: Corner, closed: float
) -> AmplifierNoise:
    """`.noise` of the reset, at the inputs' difference, and of the signal, at the lane. closed: LSB."""
    lsb = setup.spec.lsb
    inputs = (2 * UNITS + sizes.feedback) / sizes.feedback
    inputs_apart = [f"Eapart apart 0 {INNER}xm {INNER}xp 1"]
    reset = _rms(setup, spec, sizes, corner, inputs_apart, corner.supply, "v(apart)") * inputs
    array = with_lane(setup, lane, corner, " noisy=0")
    return AmplifierNoise(reset / lsb, _rms(setup, spec, sizes, corner, array, 0.0, "v(lane)") / lsb, closed)


def still(
    setup: Setup, spec: AmplifierSpec, sizes: AmplifierSizes, corner: Corner, reset: float, driven: str
) -> list[str]:
    """Return the deck of an amplifier that rests with ``reset`` at a level, V; ``driven`` has an amplitude of 1 V."""
    volts = {"vdd": corner.supply, "vss": 0.0, "vref": spec.vref, "wake": corner.supply, "reset": reset}
    volts |= dict.fromkeys(PICK, 0.0)
    volts |= dict.fromkeys(("column_a", "column_b"), spec.reset_level)
    volts |= {f"g{k}": corner.supply * (k == TRIM_BITS - 1) for k in range(TRIM_BITS)}
    return [
        *SETTINGS.options,
        *deck(biased(amplifier(sizes)), setup, corner),
        f".temp {corner.temperature:g}",
        *(f"V{name} {name} 0 dc {level:g}{' ac 1' * (name == driven)}" for name, level in volts.items()),
        "Vbias vdd_bias vdd 0",
    ]


def with_lane(setup: Setup, lane: LaneSizes, corner: Corner, noisy: str = "") -> list[str]:
    """Return a lane's array at the output, and loops that give floating inputs an operating point."""
    return [
        f"Rlane out lane {LANE_OHM:g}{noisy}",
        f"Clane lane 0 {load_of(setup, lane, corner):g}",
        f"Rloop out {INNER}xm {LOOP:g}{noisy}",
        f"Rzero vref {INNER}xp {LOOP:g}{noisy}",
    ]


def _rms(
    setup: Setup, spec: AmplifierSpec, sizes: AmplifierSizes, corner: Corner, more: list[str], reset: float, what: str
) -> float:
    """Return the noise of ``what`` over BAND, V rms."""
    lines = [
        "* noise of the amplifier",
        *still(setup, spec, sizes, corner, reset, "column_a"),
        *more,
        ".control",
        f"noise {what} Vcolumn_a {BAND}",
        "print onoise_total",
        "quit",
        ".endc",
        ".end",
    ]
    with tempfile.TemporaryDirectory(prefix="talbot-") as folder:
        file = Path(folder) / "deck.sp"
        file.write_text("\n".join([*lines, ""]), encoding="utf-8")
        done = finish(["ngspice", "-n", "-b", file], env={"OMP_NUM_THREADS": "1"})
    found = re.search(r"onoise_total = (\S+)", done.stdout)
    if not found:
        raise ToolError(f"ngspice: no noise of the amplifier: {(done.stdout + done.stderr).strip()[-400:]}")
    return float(found[1])
