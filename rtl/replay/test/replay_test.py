"""Traces of a block's tests: they match its Verilog and its gates, and report a bug by test, cycle and port."""

import subprocess
import sys

import pytest

from talbot.base.command import main
from talbot.base.paths import ROOT
from talbot.base.tools import plain
from talbot.rtl.harness.testbench import build, hooked
from talbot.rtl.harness.translate import translate_component
from talbot.rtl.quad_divider import quad_divider
from talbot.rtl.replay import command, load, record, replay, replay_files

LIBRARY = plain(ROOT / "cells" / "gates.lib")
pytestmark = pytest.mark.needs("iverilog")
needs_yosys = pytest.mark.needs("yosys")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("replay")


@pytest.fixture(scope="module")
def recorded(folder):
    """The trace of EdgeAdc's tests, and its Verilog."""
    (path,) = record("EdgeAdc", folder / "traces")
    verilog = folder / "EdgeAdc.v"
    verilog.write_text(load(path).verilog())
    return path, verilog


@pytest.fixture(scope="module")
def gates(folder, recorded):
    """The netlist of EdgeAdc in the abstract library's cells, and the cells' models."""
    netlist, cells = folder / "gates.v", folder / "cells.v"
    for script in (
        f"read_verilog -sv {recorded[1]}; synth -flatten -top EdgeAdc; delete t:$scopeinfo; "
        f"dfflibmap -liberty {LIBRARY}; "
        f"abc -liberty {LIBRARY}; hilomap -hicell TIE1 Y -locell TIE0 Y -singleton; opt_clean -purge; "
        f"write_verilog -noattr {netlist}",
        f"read_liberty {LIBRARY}; write_verilog -noattr {cells}",
    ):
        subprocess.run(["yosys", "-q", "-p", script], check=True, capture_output=True, timeout=400)
    return netlist, cells


def planted(verilog, folder, old, new):
    """Return ``verilog`` with one text replaced by another."""
    text = verilog.read_text()
    assert text.count(old) >= 1
    path = folder / "planted.v"
    path.write_text(text.replace(old, new, 1))
    return path


def test_every_cycle_of_the_tests_fits_the_verilog(recorded):
    path, verilog = recorded
    trace = load(path)
    assert trace.cycles == len(trace.lines) > 3000 and len({name for _, name in trace.tests}) >= 9
    assert not any("FL::" in name or "CL::" in name for _, name in trace.tests)
    assert replay_files([path], [verilog]) == []


def test_a_bug_is_named_by_test_cycle_and_port(recorded, folder):
    path, verilog = recorded
    bug = planted(verilog, folder, "dac = ", "dac = 8'd1 ^ ")
    found = replay_files([path], [bug])
    assert [m.port for m in found] == ["dac"] and "edge_adc_test.py::" in found[0].test
    got, want = int(found[0].got, 2), int(found[0].expected, 2)
    assert want == load(path).values(found[0].cycle)[1]["dac"] and got == want ^ 1


def test_x_after_a_reset_does_not_match(recorded, folder):
    path, verilog = recorded
    bug = planted(verilog, folder, "if ( reset ) begin", "if ( 1'b0 ) begin")
    found = replay_files([path], [bug])
    assert found and any("x" in m.got for m in found)


def test_a_message_counts_while_it_is_valid(recorded, folder):
    path, verilog = recorded
    bug = planted(verilog, folder, "out__msg = ", "out__msg = {8{~out__val}} ^ ")
    assert replay_files([path], [bug]) == []
    assert [m.port for m in replay_files([path], [bug], strict=True)] == ["out__msg"]


def test_a_simulation_without_an_end_does_not_match(recorded, folder):
    path, verilog = recorded
    bug = planted(verilog, folder, "endmodule", "reg s; initial s = 0; always @(s) s <= ~s;\nendmodule")
    found = replay_files([path], [bug], seconds=1)
    assert [(m.port, m.expected) for m in found] == [("simulation", "an end")]


@needs_yosys
def test_gates(recorded, gates, folder):
    path, _ = recorded
    netlist, cells = gates
    assert replay_files([path], [netlist], cells=[cells]) == []
    wrong = planted(cells, folder, "A ^ B", "A | B")
    assert replay_files([path], [netlist], cells=[wrong])


@needs_yosys
@pytest.mark.parametrize("simulator", ["icarus", pytest.param("verilator", marks=pytest.mark.slow)])
def test_the_tests_themselves_run_on_gates(gates, folder, simulator):
    netlist, cells = gates
    command = [
        sys.executable,
        "-m",
        "pytest",
        "-p",
        "no:cacheprovider",
        "rtl/edge_adc",
        "-k",
        "every_code",
        "--netlist-in",
        simulator,
        "--netlist",
        f"EdgeAdc={netlist}",
        "--cells",
    ]
    good = subprocess.run([*command, cells], cwd=ROOT, capture_output=True, text=True)
    assert good.returncode == 0 and "1 passed" in good.stdout, good.stdout
    bad = subprocess.run([*command, planted(cells, folder, "A ^ B", "A | B")], cwd=ROOT, capture_output=True, text=True)
    assert bad.returncode == 1 and "1 failed" in bad.stdout, bad.stdout


def test_of_several_sizes_those_run_that_have_a_netlist(folder):
    """Of a divider's tests, all of whose sizes are tested together, on the netlist of one."""
    netlist = folder / "divider.v"
    netlist.write_text(translate_component(quad_divider("radix4", 7), "QuadDividerRadix4"))
    command = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", "rtl/quad_divider", "-k"]
    tests = "test_edges or (EverySize and (radix4_7 or radix4_8))"
    given = f"--netlist=QuadDivider_radix4_7_10={netlist}:QuadDividerRadix4"
    done = subprocess.run([*command, tests, given], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0 and "2 passed, 1 skipped" in done.stdout, done.stdout


def test_traces_of_several_simulators_are_joined():
    from talbot.rtl.edge_adc import EdgeAdc
    from talbot.rtl.replay.recorder import Recorder

    recorder = Recorder("EdgeAdc")
    with hooked(observe=recorder.observe):
        for test, ticks in (("one", 5), (None, 4), ("two", 7)):  # None: a test whose trace is left out
            recorder.test = test
            sim = build(EdgeAdc())
            for _ in range(ticks):
                sim.sim_tick()
    (trace,) = recorder.traces()
    assert [line[0] for line in trace.lines].count("1") == 2 and len(trace.lines) == 5 + 7 + 2 * 3
    assert [trace.test_at(cycle) for cycle in (0, 7, 8)] == ["one", "one", "two"]


def test_command(recorded, folder, capsys):
    path, verilog = map(str, recorded)
    assert main(command, ["replay", path, "--verilog", verilog]) == 0
    bug = planted(recorded[1], folder, "dac = ", "dac = 8'd1 ^ ")
    assert main(command, ["replay", path, "--verilog", str(bug)]) == 1
    assert "dac: expected" in capsys.readouterr().out
    assert main(command, ["replay", path, "--verilog", verilog + "x"]) == 2
    assert "file = " in capsys.readouterr().err


def test_a_trace_in_memory(recorded):
    path, verilog = recorded
    trace = load(path)
    assert replay(trace, [verilog]) == []
    fresh, inputs, outputs = trace.lines[100].split()
    trace.lines[100] = f"{fresh} {inputs} {int(outputs, 16) ^ 1:x}"
    assert [m.cycle for m in replay(trace, [verilog])] == [100]
