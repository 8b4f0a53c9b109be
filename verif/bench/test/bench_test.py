"""The cocotb benches pass in both simulators, report errors, and always end."""

import json
from importlib.util import find_spec

import pytest

from talbot.base.command import main
from talbot.base.records import from_json
from talbot.models.chip import golden_frame
from talbot.verif.bench import command, simulation
from talbot.verif.bench.command import CHIP, SAME, BenchRun, summary
from talbot.verif.bench.exposure import FRAMES, FRONT_END, SENSOR, samples
from talbot.verif.bench.pymtl_frame import pymtl_stream
from talbot.verif.results import BlockResults, Tests

needs_icarus = pytest.mark.needs("iverilog")
SMALL = "raw, a window"


def streams_of(simulators, tmp_path):
    """Return the bytes of one frame of the chip's bench in each simulator."""
    for simulator in simulators:
        file = tmp_path / simulator
        tests = simulation.simulate(
            simulation.DESIGNS[CHIP],
            simulator,
            tests=["the_shown_frame"],
            environment={"BENCH_STREAM": str(file), "BENCH_FRAME": SMALL},
        )
        assert tests == [simulation.BenchTest("the_shown_frame", None)]
        yield file.read_bytes()


@needs_icarus
def test_a_bench_passes_and_counts(tmp_path, capsys):
    assert (
        main(command, ["--block", "PhasePath", "--simulator", "icarus", "--out", str(tmp_path), "--workers", "1"]) == 0
    )
    by_block = json.loads((tmp_path / "bench.json").read_text())
    found = from_json(dict[str, BlockResults], by_block)
    two = Tests(passed=2)
    assert found == {"PhasePath": BlockResults(tests=two, benches={"Icarus": two}, simulators=["Icarus"])}


@needs_icarus
def test_a_lost_stall_fails_and_is_named(monkeypatch, tmp_path, capsys):
    good = simulation.sources

    def planted(design):
        texts = good(design)
        key, stall = f"{design.block}.v", "divider__send__val & send__rdy"
        assert texts[key].count(stall) == 1
        return texts | {key: texts[key].replace(stall, "divider__send__val")}

    monkeypatch.setattr(simulation, "sources", planted)
    arguments = [
        "--block",
        "PhasePath",
        "--simulator",
        "icarus",
        "--seed",
        "3",
        "--out",
        str(tmp_path),
        "--workers",
        "1",
    ]
    for _ in range(2):  # a failure is tried again
        assert main(command, arguments) == 1
        found = capsys.readouterr().err
        assert "PhasePath in icarus: any_taps_at_any_pace: " in found
        assert "again: talbot cocotb --block PhasePath --seed 3" in found
    assert not list((tmp_path / "bench").iterdir())


@needs_icarus
def test_a_simulation_without_an_end_is_stopped(monkeypatch):
    monkeypatch.setattr(simulation, "SECONDS", 2)
    monkeypatch.setattr(
        simulation,
        "sources",
        lambda design: {
            f"{simulation.TOP}.v": simulation.flat(design)
            .replace("endmodule", "reg s; initial s = 0; always @(s) s <= ~s;\nendmodule")
            .replace("PhasePath dut", "//")
        },
    )
    with pytest.raises(simulation.BenchError, match="PhasePath in icarus: no end after 2 s"):
        simulation.simulate(simulation.DESIGNS["PhasePath"], "icarus")


@pytest.mark.parametrize("design", simulation.DESIGNS.values(), ids=lambda design: design.block)
def test_every_bench_exists(design):
    assert find_spec(design.module)


def test_streams_that_differ_fail():
    runs = {(CHIP, name): BenchRun([], "00") for name in ("pymtl", "icarus")}
    assert summary(runs)[CHIP].open_points == []
    runs[CHIP, "verilator"] = BenchRun([], None)
    (point,) = summary(runs)[CHIP].open_points
    assert SAME in point


@needs_icarus
@pytest.mark.slow
def test_pymtl_icarus_and_verilator_give_the_same_bytes(tmp_path):
    golden = golden_frame(samples(), SENSOR, FRAMES[SMALL], FRONT_END).stream
    assert [*streams_of(simulation.SIMULATORS, tmp_path), pymtl_stream(FRAMES[SMALL])] == [golden] * 3
