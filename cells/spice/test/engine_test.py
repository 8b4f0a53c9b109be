"""The engine on circuits whose answer is known."""

import os
import signal
import threading

import numpy as np
import pytest

from talbot.cells.spice.engine import SimulationError, Simulator
from talbot.cells.spice.settings import Settings
from talbot.cells.spice.wave import Wave
from talbot.models.parameters import ParameterError

RC = [".subckt rc A Y", "R1 A Y 1k", ".ends", "Xcell A Y rc"]
ngspice = pytest.mark.needs("ngspice")


@ngspice
def test_a_resistor_and_a_capacitor_take_the_time_they_should():
    """Step through 1 kohm into 1 and 2 pF: 50 % after RC ln 2, and a charge of CV."""
    with Simulator(RC, ["A"], ["Y"], {}, 25, Settings(reltol=1e-5)) as simulator:
        for load in (1e-12, 2e-12):
            wave = simulator.transient({"A": [(0, 0), (1e-9, 0), (1.001e-9, 1)]}, {"Y": load}, 20e-9, 0.1e-9)
            assert wave.cross("Y", 0.5, True) - 1.0005e-9 == pytest.approx(1e3 * load * np.log(2), rel=5e-3)
            assert wave.charge("A", 0, 20e-9) == pytest.approx(load, rel=2e-3)
        assert (simulator.runs, simulator.repeated) == (2, 0)


@ngspice
def test_a_failure_names_its_reason_and_gives_a_deck(tmp_path):
    broken = [".subckt rc A Y", "X1 A Y nowhere", ".ends", "Xcell A Y rc"]
    simulator = Simulator(broken, ["A"], ["Y"], {}, 25, Settings(timeout=5))
    with simulator, pytest.raises(SimulationError, match="unknown subckt") as caught:
        simulator.transient({"A": [(0, 0), (1e-9, 1)]}, {"Y": 1e-15}, 2e-9, 1e-10)
    assert "X1 A Y nowhere" in caught.value.deck and ".tran" in caught.value.deck and simulator.repeated == 1


@ngspice
def test_a_run_beyond_its_time_is_ended():
    with Simulator(RC, ["A"], ["Y"], {}, 25) as simulator:
        simulator.transient({"A": [(0, 0), (1e-9, 1)]}, {"Y": 1e-15}, 2e-9, 1e-10)
        slow = Settings(timeout=0.2)
        with pytest.raises(SimulationError, match="timeout"):
            simulator.transient({"A": [(0, 0), (1e-9, 1)]}, {"Y": 1e-15}, 1e-3, 1e-12, settings=slow)


@ngspice
@pytest.mark.needs("/proc")
def test_a_busy_machine_is_no_time_out():
    """A child that gets no processor for longer than its time-out, here a stopped one, has its answer waited for."""
    with Simulator(RC, ["A"], ["Y"], {}, 25) as simulator:
        stimulus = {"A": [(0, 0), (1e-9, 1)]}
        simulator.transient(stimulus, {"Y": 1e-15}, 2e-9, 1e-10)
        os.kill(simulator._child.pid, signal.SIGSTOP)
        threading.Timer(1.5, os.kill, (simulator._child.pid, signal.SIGCONT)).start()
        before = simulator._child.pid
        wave = simulator.transient(stimulus, {"Y": 1e-15}, 2e-9, 1e-10, settings=Settings(timeout=1))
        assert wave.time[-1] == pytest.approx(2e-9) and simulator._child.pid == before


def test_crossings_are_between_the_points_and_the_last_counts():
    wave = Wave(
        np.array([0.0, 1.0, 2.0, 3.0, 4.0]),
        {"y": np.array([0.0, 1.0, 0.0, 1.0, 1.0])},
        {"s": np.array([0.0, 2.0, 2.0, 0.0, 0.0])},
    )
    assert wave.cross("y", 0.25, True) == pytest.approx(2.25)
    assert wave.cross("y", 0.25, False) == pytest.approx(1.75)
    assert wave.cross("y", 0.25, True, after=3.5) is None
    assert wave.charge("s", 0.5, 2.5) == pytest.approx(0.75 + 2 + 0.75)


@pytest.mark.parametrize(
    "field, value", [("reltol", 0), ("trtol", 0), ("steps", 0), ("timeout", 0), ("method", "euler")]
)
def test_settings_are_checked(field, value):
    with pytest.raises(ParameterError, match=field):
        Settings(**{field: value})


def test_tight_tolerances_are_first_loosened_a_little():
    """A column's transient that failed at 2e-5 had those of 1e-3 next but Gear's method, and 2.3 LSB of error."""
    assert [(one.method, one.reltol) for one in Settings(reltol=2e-5).retries] == [
        ("trap", pytest.approx(1e-4)),
        ("gear", 2e-5),
        ("gear", 1e-3),
    ]
    assert [one.method for one in Settings().retries] == ["gear", "gear"]
