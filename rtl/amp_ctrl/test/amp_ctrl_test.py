"""AmpCtrl: every cycle of every pin equals the golden waveform, at every level."""

import random
from itertools import product

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from talbot.models.digital.amp_ctrl import PIN_NAMES, AmpPins, Slot, row_cycles, row_waveform
from talbot.models.parameters import AmpTiming
from talbot.rtl.amp_ctrl import AmpCtrl, AmpCtrlFL
from talbot.rtl.amp_ctrl.ports import DURATIONS, SLOT
from talbot.rtl.harness.reset import outputs_after_reset
from talbot.rtl.harness.testbench import build

# A test that several levels inherit runs on each of them, as intended.
SETTINGS = settings(max_examples=25, deadline=None, suppress_health_check=[HealthCheck.differing_executors])
PHASES = ("pixel_reset", "integrate", "cm_reset", "read")

slots = st.builds(Slot, *[st.booleans()] * 3)
timings = st.builds(AmpTiming, **{name: st.integers(1, 5) for name in DURATIONS}, n_cm=st.integers(0, 3))


def drive(sim, timing=None, four_tap=0, **ports):
    """Set the inputs; ``timing``: AmpTiming, or None to leave them."""
    if timing is not None:
        for name in (*DURATIONS, "n_cm"):
            port = getattr(sim, name)
            port @= getattr(timing, name)
        sim.four_tap @= four_tap
    for name, value in ports.items():
        port = getattr(sim, name)
        port @= value


def slot_ports(slot):
    return {f"slot_{name}": int(on) for name, on in vars(slot).items()}


def pins(sim):
    return {name: int(getattr(sim, name)) for name in PIN_NAMES}


@pytest.fixture(scope="class")
def sim(request):
    return build(request.cls.level(), request.cls.verilog, "AmpCtrl")


class TestAmpCtrlFL:
    level = AmpCtrlFL
    verilog = False

    def fresh(self, sim):
        sim.sim_reset()
        drive(sim, start=0, hold_free=1, **slot_ports(Slot()))
        return sim

    def check_row(self, sim, timing, four_tap, free, noise=None, slot=Slot()):
        """One row, cycle by cycle; ``free``: hold_free by cycle; ``noise``: random starts and durations while busy."""
        drive(sim, timing, four_tap, start=1, **slot_ports(slot))
        sim.sim_tick()
        drive(sim, start=0)
        golden = row_waveform(timing, bool(four_tap), slot)
        expected, cycle = next(golden), 0
        while True:
            assert pins(sim) == vars(expected), f"cycle {cycle}"
            assert sum(pins(sim)[p] for p in PHASES) <= 1
            if expected.done:
                return cycle
            hold_free = free(cycle)
            drive(sim, hold_free=int(hold_free))
            if noise:
                drive(
                    sim,
                    AmpTiming(*(noise.randint(1, 9) for _ in DURATIONS), noise.randint(0, 9)),
                    start=noise.randint(0, 1),
                    **{name: noise.randint(0, 1) for name in SLOT},
                )
            sim.sim_tick()
            expected, cycle = golden.send(hold_free), cycle + 1

    @SETTINGS
    @given(timings, st.booleans(), st.lists(slots, min_size=2, max_size=2), st.integers(0, 2**32))
    def test_waveform(self, sim, timing, four_tap, slots, seed):
        noise = random.Random(seed)
        self.fresh(sim)
        for slot in slots:
            self.check_row(sim, timing, int(four_tap), lambda _: noise.random() < 0.7, noise, slot)
            drive(sim, start=0)
            sim.sim_tick()
            assert pins(sim) == vars(AmpPins())

    @pytest.mark.parametrize("four_tap", [0, 1])
    def test_cycles(self, sim, four_tap):
        timing = AmpTiming(7, 11, 3, 5, 2, 4, n_cm=2)
        assert self.check_row(self.fresh(sim), timing, four_tap, lambda _: True) == row_cycles(timing, four_tap)

    @pytest.mark.parametrize("slot", [Slot(*map(bool, bits)) for bits in product((0, 1), repeat=3)], ids=str)
    def test_what_a_slot_leaves_out_takes_its_time(self, sim, slot):
        timing = AmpTiming(2, 4, 3, 2, 3, 1, n_cm=2)
        assert self.check_row(self.fresh(sim), timing, 0, lambda _: True, slot=slot) == row_cycles(timing)

    def test_back_to_back(self, sim):
        """A start in the cycle of `done` is accepted."""
        self.fresh(sim)
        for _ in range(3):
            self.check_row(sim, AmpTiming(1, 1, 1, 1, 1, 1, n_cm=0), 0, lambda _: True)

    @pytest.mark.parametrize("name", DURATIONS)
    def test_zero_duration_is_refused(self, sim, name):
        self.fresh(sim)
        drive(sim, AmpTiming(2, 2, 2, 2, 2, 2, n_cm=1))
        drive(sim, start=1, **{name: 0})
        sim.sim_tick()
        drive(sim, start=0)
        for _ in range(20):
            assert int(sim.cfg_err) and not any(pins(sim).values())
            sim.sim_tick()
        self.check_row(sim, AmpTiming(2, 2, 2, 2, 2, 2, n_cm=1), 0, lambda _: True)
        assert not int(sim.cfg_err)

    @SETTINGS
    @given(timings, st.integers(0, 60))
    def test_reset_at_any_moment(self, sim, timing, cycles):
        self.fresh(sim)
        drive(sim, timing, start=1)
        sim.sim_tick()
        drive(sim, start=0)
        for _ in range(cycles):
            sim.sim_tick()
        sim.reset @= 1
        sim.sim_tick()
        sim.reset @= 0
        assert not any(pins(sim).values())
        self.check_row(sim, timing, 0, lambda _: True)

    @pytest.mark.parametrize("name", DURATIONS)
    def test_all_bits_of_the_configuration(self, sim, name):
        """A duration with one high bit is long: its phase is still high when a later reset ends the row."""
        for bit in range(16):
            self.fresh(sim)
            timing = AmpTiming(**{**dict.fromkeys(DURATIONS, 1), name: 1 << bit | 1}, n_cm=bit % 2)
            drive(sim, timing, start=1)
            sim.sim_tick()
            drive(sim, AmpTiming(1, 1, 1, 1, 1, 1, n_cm=0), start=0)
            golden = row_waveform(timing, False)
            expected = next(golden)
            for cycle in range(24):
                assert pins(sim) == vars(expected), f"bit {bit}, cycle {cycle}"
                if expected.done:
                    break
                sim.sim_tick()
                expected = golden.send(True)

    def test_every_number_of_common_mode_resets(self, sim):
        for four_tap, number in product((0, 1), (*(1 << bit for bit in range(8)), 0)):
            self.check_row(self.fresh(sim), AmpTiming(1, 1, 1, 1, 1, 1, n_cm=number), four_tap, lambda _: True)

    def test_read_waits_for_the_hold(self, sim):
        self.check_row(self.fresh(sim), AmpTiming(1, 2, 3, 2, 1, 2, n_cm=1), 1, lambda cycle: cycle % 50 > 45)


class TestAmpCtrlRTL(TestAmpCtrlFL):
    level = AmpCtrl

    def test_outputs_after_a_reset(self, sim):
        assert outputs_after_reset(sim) == outputs_after_reset(build(AmpCtrlFL()), before=0)


class TestAmpCtrlVerilog(TestAmpCtrlRTL):
    verilog = True

    def test_longest_durations(self, sim):
        """All 16 bits of a duration have an effect."""
        self.fresh(sim)
        drive(sim, AmpTiming(1, 65535, 1, 1, 1, 1, n_cm=0), start=1)
        sim.sim_tick()
        drive(sim, start=0)
        high = 0
        while not int(sim.done):
            high += int(sim.integrate)
            sim.sim_tick()
        assert high == 65535


class TestAmpCtrlIcarus(TestAmpCtrlRTL):
    verilog = "icarus"
