"""The cocotb benches pass in both simulators, report errors, and always end."""

import json
from importlib.util import find_spec

import pytest

from talbot.base.command import main
from talbot.base.records import from_json
from talbot.verif.bench import command, simulation
from talbot.verif.results import BlockResults, Tests

needs_icarus = pytest.mark.needs("iverilog")


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
