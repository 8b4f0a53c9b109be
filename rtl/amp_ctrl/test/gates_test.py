"""AmpCtrl as gates: many rows with different configurations in parallel, every pin in every cycle."""

from itertools import product

import numpy as np
import pytest

from talbot.models.digital.amp_ctrl import PIN_NAMES, AmpPins, Slot, row_waveform
from talbot.models.parameters import AmpTiming
from talbot.rtl.amp_ctrl import AmpCtrl
from talbot.rtl.amp_ctrl.ports import DURATIONS, SLOT
from talbot.rtl.harness.gates import WIDE, Gates, packed, unpacked

WIDTHS = (
    dict.fromkeys(DURATIONS, 16) | {"n_cm": 8} | dict.fromkeys(("four_tap", "hold_free", "start", "reset", *SLOT), 1)
)

ROW = {f"slot_{name}": int(on) for name, on in vars(Slot()).items()}


@pytest.fixture(scope="module")
def gates():
    return Gates(AmpCtrl(), WIDE)


class Golden:
    """The golden waveform of one copy, as in AmpCtrlFL."""

    def __init__(self):
        self.row, self.pins, self.error = None, AmpPins(), 0

    def tick(self, inputs):
        if inputs["reset"]:
            self.__init__()
        elif self.row is not None:
            self.pins = self.row.send(bool(inputs["hold_free"]))
            if self.pins.done:
                self.row = None
        else:
            self.pins = AmpPins()
            if inputs["start"]:
                timing = {name: int(inputs[name]) for name in (*DURATIONS, "n_cm")}
                self.error = int(not all(timing[name] for name in DURATIONS))
                if not self.error:
                    slot = Slot(*(bool(inputs[name]) for name in SLOT))
                    self.row = row_waveform(AmpTiming(**timing), bool(inputs["four_tap"]), slot)
                    self.pins = next(self.row)


def follow(gates, inputs, cycles):
    """Compare with the golden waveforms; inputs(cycle): of all copies, by name. The first cycle resets."""
    golden = [Golden() for _ in range(WIDE)]
    for cycle in range(-1, cycles):
        now = {name: np.broadcast_to(value, WIDE) for name, value in inputs(max(cycle, 0)).items()}
        if cycle < 0:
            now["reset"] = np.ones(WIDE, int)
        for name, value in now.items():
            gates[name] = packed(value, WIDTHS[name])
        gates.tick()
        if cycle >= 0:
            for name in (*PIN_NAMES, "cfg_err"):
                got = unpacked(gates[name])
                want = [g.error if name == "cfg_err" else getattr(g.pins, name) for g in golden]
                wrong = np.flatnonzero(got != want)
                assert not wrong.size, f"{name} in cycle {cycle}: {[(k, v[wrong[0]]) for k, v in now.items()]}"
        for copy, (g, *values) in enumerate(zip(golden, *(v.tolist() for v in now.values()))):
            g.tick(dict(zip(now, values)))


def test_any_start_any_configuration_and_any_reset(gates):
    """Every input changes in every cycle; shares of starts, waits, zeros and resets differ between copies."""
    random = np.random.default_rng(1)
    longest, share = random.choice((1, 2, 3, 9), WIDE), random.random((4, WIDE))

    def inputs(cycle):
        chance = random.random((4, WIDE)) < share
        values = {name: random.integers(1, longest + 1) for name in DURATIONS}
        zero = chance[2] & (random.random((len(DURATIONS), WIDE)) < 0.04)
        values = {name: np.where(none, 0, values[name]) for name, none in zip(DURATIONS, zero)}
        values |= {"n_cm": random.integers(0, 4, WIDE), "four_tap": random.integers(0, 2, WIDE)}
        values |= {name: random.integers(0, 2, WIDE) for name in SLOT}
        return values | {"start": chance[0], "hold_free": chance[1], "reset": chance[3] & (random.random(WIDE) < 0.02)}

    follow(gates, inputs, 150)


def test_every_set_of_zeros(gates):
    """A start with any zero duration is refused; the next start is accepted."""
    zeros = np.array(list(product((0, 1), repeat=6)))
    values = np.array([1, 2, 0x100, 0x8000, 0xFFFF, 0x5555, 0x00FF, 0x0100])
    sets, others = (x.ravel() for x in np.meshgrid(np.arange(64), np.arange(8), indexing="ij"))

    def inputs(cycle):
        first = {name: np.where(zeros[sets, i], 0, values[(others + i) % 8]) for i, name in enumerate(DURATIONS)}
        now = first if cycle < 4 else dict.fromkeys(DURATIONS, 1)
        return now | {
            "start": cycle in (1, 6),
            "n_cm": 1,
            "four_tap": 0,
            "hold_free": 1,
            **ROW,
            "reset": cycle == 5 and others < 4,
        }

    follow(gates, inputs, 12)


def waveform(timing, four_tap):
    """Return the pins' levels in each segment of a row (README.md) and the first cycle of each segment."""
    t, row = timing, [(timing.t_guard, (), 0)]
    integrate, pause = (t.t_int, ("integrate", "shutter")), (t.t_guard, ("shutter",))
    for tap in range(4 if four_tap else 1):
        phases = [(t.t_reset, ("pixel_reset",)), (t.t_guard, ())]
        phases += [integrate, pause, (t.t_cm, ("cm_reset", "shutter")), pause] * t.n_cm + [integrate, (t.t_guard, ())]
        for length, pins in (t.t_settle, ("read", "ref_ctl")), (t.t_read, ("read",)):
            phases += [(length - 1, pins), (1, (*pins, "sample"))]
        row += [(*phase, tap) for phase in [*phases, (t.t_guard, ())]]
    row = [(length, (*pins, "busy"), tap) for length, pins, tap in row if length] + [(1, ("done",), 0)]
    levels = [[tap if name == "tap" else int(name in high) for name in PIN_NAMES] for _, high, tap in row]
    return np.array(levels), np.cumsum([0, *(length for length, *_ in row)])


def test_the_segments_are_the_golden_waveform():
    for timing in (AmpTiming(1, 1, 1, 1, 1, 1, n_cm=0), AmpTiming(7, 11, 3, 5, 2, 4, n_cm=2)):
        for four_tap in (False, True):
            pins, at = waveform(timing, four_tap)
            row = row_waveform(timing, four_tap)
            golden = [next(row)]
            while not golden[-1].done:
                golden.append(row.send(True))
            assert np.repeat(pins, np.diff(at), axis=0).tolist() == [list(vars(p).values()) for p in golden]


@pytest.mark.slow
def test_every_bit_of_a_duration_and_every_number_of_resets(gates):
    """Durations to 65535, one long and the others 1: the pins change when they should."""
    one = dict.fromkeys(DURATIONS, 1)
    lengths = [*(1 << bit for bit in range(16)), *((1 << bit) - 1 for bit in range(2, 17)), 0x5555, 40000]
    timings = [
        AmpTiming(**(one | {name: length}), n_cm=int(name == "t_cm")) for name in DURATIONS for length in lengths
    ]
    timings += [AmpTiming(**one, n_cm=number) for number in range(256)]
    timings += timings[: WIDE - len(timings)]
    gates["four_tap"], gates["hold_free"], gates["reset"] = 0, 1, 1
    for name, level in ROW.items():
        gates[name] = level
    gates.tick()
    gates["reset"], gates["start"] = 0, 1
    for name in (*DURATIONS, "n_cm"):
        gates[name] = packed([getattr(timing, name) for timing in timings], WIDTHS[name])
    gates.tick()
    for name in (*DURATIONS, "n_cm", "start"):
        gates[name] = 0
    seen = []  # cycle, pins: where a pin of any copy changes
    for cycle in range(0xFFFF + 30):
        gates.tick()
        pins = np.stack([gates[name][0] for name in PIN_NAMES])  # of one tap
        if not seen or (pins != seen[-1][1]).any():
            seen.append((cycle, pins))
    at, pins = (
        np.array([cycle for cycle, _ in seen]),
        np.array([[unpacked(row[None]).astype(np.int8) for row in x] for _, x in seen]),
    )
    for copy, timing in enumerate(timings):
        levels, ends = waveform(timing, False)
        golden = np.flatnonzero(np.any(levels[1:] != levels[:-1], axis=1)) + 1
        golden = golden[ends[golden] <= at[-1]]
        change = np.flatnonzero(np.any(pins[1:, :, copy] != pins[:-1, :, copy], axis=1)) + 1
        change = change[: len(golden)]
        assert at[change].tolist() == ends[golden].tolist(), timing
        assert (pins[change, :, copy] == levels[golden]).all(), timing
