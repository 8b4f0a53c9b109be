"""Transitions as they settle, the fit of events, what is evaluated and shown of them, frames and bad input."""

from dataclasses import replace

import numpy as np
import pytest

from talbot.base.command import main
from talbot.base.steps import StepError
from talbot.base.tools import run
from talbot.flow.layout.chain import timing_steps
from talbot.flow.layout.design import design
from talbot.flow.layout.energy import command
from talbot.flow.layout.energy.count import counted_verilog, read_counts
from talbot.flow.layout.energy.fit import fit
from talbot.flow.layout.energy.frames import (
    EVERY,
    FRAMES,
    HELD_BACK,
    RECORDED,
    RECORDED_TILES,
    EnergyFrame,
    frame_named,
)
from talbot.flow.layout.energy.measure import FrameParameters, Transitions
from talbot.flow.layout.energy.report import page, text
from talbot.flow.layout.energy.result import Frame, evaluate
from talbot.flow.layout.options import Options
from talbot.flow.layout.steps.stimulus import middle
from talbot.models.chip import front_end_of, golden_frame
from talbot.models.parameters import ParameterError
from talbot.models.parameters.energy import DigitalEvents
from talbot.rtl.sensor_options import sensor_with
from talbot.signoff.netlist.netlist import Instance, Netlist, Port

PJ = dict(zip(DigitalEvents._fields, (20.0, 300.0, 9.0, 4.0, 11.0, 50.0), strict=True))

# n[3] follows `a` through four inverters: at zero delay, too, `odd` (a xor n[3]) has a glitch at each edge of a
NETLIST = Netlist(
    "Chip",
    (Port("a", "input", 1), Port("odd", "output", 1)),
    tuple(Instance(f"u{k}", "inv", {"i": "a" if k == 0 else f"n[{k - 1}]", "q": f"n[{k}]"}) for k in range(4))
    + (Instance("x", "xor2", {"i0": "a", "i1": "n[3]", "q": "odd"}),),
)
CELLS = """
module inv (input i, output q); not (q, i); endmodule
module xor2 (input i0, input i1, output q); xor (q, i0, i1); endmodule
"""
CLOCK = """
module Bench (input a, input busy); wire odd; Chip chip (.a(a), .odd(odd)); endmodule
module Clock;
  reg clk = 0, reset = 1, a = 0, busy = 0, done = 0;
  Bench bench (.a(a), .busy(busy));
  always #5 clk = ~clk;
  integer k;
  initial begin
    #42 reset = 0;
    repeat (2) @(posedge clk);
    for (k = 0; k < 3; k = k + 1) @(posedge clk) a <= ~a;
    @(posedge clk) busy <= 1;
    for (k = 0; k < 7; k = k + 1) @(posedge clk) a <= ~a;
    @(posedge clk) busy <= 0;
    @(posedge clk);
    @(posedge clk) done <= 1;
    @(posedge clk) $finish;
  end
endmodule
"""


def counts(folder, clock=CLOCK):
    for name, verilog in (("chip", counted_verilog(NETLIST)), ("cells", CELLS), ("clock", clock)):
        (folder / f"{name}.v").write_text(verilog)
    sources = [folder / f"{name}.v" for name in ("chip", "cells", "clock")]
    run(["iverilog", "-g2012", "-s", "Clock", "-s", "Meter", "-o", folder / "program", *sources])
    run(["vvp", "-n", folder / "program", f"+counts={folder / 'counts'}"])
    return folder / "counts"


@pytest.mark.needs("iverilog")
def test_what_does_not_remain_is_no_transition(tmp_path):
    parts = read_counts(counts(tmp_path), NETLIST)
    chain = dict.fromkeys(("a", "n[0]", "n[1]", "n[2]", "n[3]"), 3)
    assert parts["host"].transitions == chain | {"odd": 0}
    assert parts["frame"].transitions == dict.fromkeys(chain, 7) | {"odd": 0}
    assert set(parts["after"].transitions.values()) == {0}
    assert parts["frame"].cycles == 8 and parts["after"].cycles == 2


@pytest.mark.needs("iverilog")
def test_a_run_that_ends_early_is_refused(tmp_path):
    with pytest.raises(StepError, match="'after'"):
        read_counts(counts(tmp_path, CLOCK.replace("done <= 1", "done <= 0")), NETLIST)


def frames(seed=1, count=12):
    """Frames whose energies are exactly those of PJ."""
    rng = np.random.default_rng(seed)
    made = []
    for k in range(count):
        events = DigitalEvents(*(int(n) for n in rng.integers(1, (5000, 9, 800, 4000, 900, 200))))
        made.append(frame(f"f{k}", events))
    return made


def frame(name, events, factor=1.0):
    pj = factor * sum(PJ[event] * count for event, count in events._asdict().items())
    return Frame(name, "-", events, pj, {"clock tree": pj}, 2 * pj, 2 * events.cycles, 20.0)


def test_the_fit_finds_what_the_energies_were_made_of():
    made = frames()
    found = fit([f.events for f in made], [f.pj for f in made])
    assert found.pj == pytest.approx(PJ) and found.left_out == pytest.approx([0] * len(made), abs=1e-9)


def test_an_outlier_is_seen_where_it_is_left_out():
    made = frames()
    pj = [f.pj * (1.5 if k == 4 else 1) for k, f in enumerate(made)]
    found = fit([f.events for f in made], pj)
    assert found.left_out[4] == pytest.approx(1 / 1.5 - 1) and abs(found.left_out[4]) == max(map(abs, found.left_out))


def test_no_event_gives_energy_back():
    made = frames()
    pj = [f.pj - 2 * PJ["bytes"] * f.events.bytes for f in made]
    assert min(fit([f.events for f in made], pj).pj.values()) == 0


def delayed(pj_cycle):
    return {"parameters": {"period_ns": 20.0}, "metrics": {"energy_pj_cycle": pj_cycle, "by_kind": {"leakage": 1.5}}}


def summary(factor=1.0):
    *fitted, held_back, recorded = frames(count=14)
    held_back = frame("held_back", held_back.events, factor)
    found = evaluate(fitted, held_back, recorded, delayed(1.1 * recorded.run_pj / recorded.run_cycles + 0.03))
    known = {
        "supply_v": 1.8,
        "corner": "tt",
        "design": "chip",
        "pdk": "sky130",
        "leakage_uw": 1.5,
        "inputs": {"spef": "0"},
        "tools": {},
    }
    return found | known


def test_evaluated():
    found = summary(1.25)
    assert found["held_back"]["residual"] == pytest.approx(-0.2, abs=1e-5)
    assert found["recorded"]["residual"] == pytest.approx(0, abs=1e-5)
    assert found["glitches"]["ratio"] == pytest.approx(1.1, abs=1e-3)
    shown, printed = page(found), text(found)
    assert "-20.0 %" in shown and "-20.0 %" in printed and "1.100 times" in printed


@pytest.mark.slow
def test_events_of_a_golden_frame():
    frame = EnergyFrame("x", mode="tof", phase=True, first=(48, 8), last=(48, 9))
    asked, samples, front_end = frame.shot(np.full((4, 384, 384, 2), 30.0), [7] * 24)
    golden = golden_frame(samples, asked.sensor, asked.frame, front_end)
    pixels = 4 * 2 * 6  # rows of two tiles
    found = golden.digital_events(1234)
    assert found._replace(bytes=0) == DigitalEvents(1234, 4, 4 * pixels, 4 * pixels * 8, 0, pixels)
    assert found.bytes == len(golden.stream)


def test_every_frame_is_one_that_can_be_asked_for():
    every = EVERY
    assert len({f.name for f in every}) == len(every) == len({replace(f, name="") for f in every})
    assert all(f.requested().sensor.array.rows == 384 for f in every)
    assert HELD_BACK.scene != FRAMES[0].scene and all(frame_named(f.name) is f for f in every)
    assert len({Transitions(FrameParameters(f)).name for f in every}) == len(every)


def test_trims_in_the_samples_are_as_trims_in_the_registers():
    rng = np.random.default_rng(3)
    samples, trims = rng.uniform(0, 60, (1, 384, 384, 2)), rng.integers(-200, 200, 24)
    asked, shot, front_end = FRAMES[0].shot(samples, trims)
    wanted = front_end_of(asked.lit, trims).values(samples, "edge")
    assert front_end.trim == (0,) * 24 and front_end.values(shot, "edge") == pytest.approx(wanted)


def test_the_recorded_frame_is_that_of_the_chip_with_delays():
    step = next(s for s in timing_steps(design("asp_chip"), Options()) if s.name == "stimulus")
    p, asked = step.parameters, RECORDED.requested()
    assert (sensor_with(p.options), p.tiles) == (asked.sensor, RECORDED_TILES)
    assert asked.frame.phase and asked.frame.window == middle(asked.sensor.full_window, p.tiles)


def test_bad_input(tmp_path, capsys):
    with pytest.raises(ParameterError, match="frame = 'none': must be one of edge, "):
        frame_named("none")
    with pytest.raises(StepError, match="must be the one"):
        FrameParameters(EnergyFrame("edge", threshold=3))
    ask = ["--out", str(tmp_path / "out"), "--liberty", str(tmp_path / "none.lib")]
    assert main(command, ask) == 2 and "none.lib: no such file" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()
