"""The small die from end to end: results under their names, limits that gate it."""

import json

import pytest

from talbot.base.steps import Runner
from talbot.flow.layout.design import DESIGNS
from talbot.flow.layout.options import Options
from talbot.flow.layout.report.metrics import broken
from talbot.flow.layout.sensor.die import lay_out_die
from talbot.flow.layout.sensor.metrics import RULES
from talbot.flow.layout.sensor.plan import BLOCKS, DieParameters
from talbot.flow.layout.sensor.test import small
from talbot.flow.layout.steps.library import Library
from talbot.platforms.sky130.chipignite import CARAVAN
from talbot.platforms.wires import CORNERS

pytestmark = pytest.mark.needs("layout")


RESULTS = "gds", "v", "drc.lyrdb", "connectivity.json", "parasitics.json", "sdc", "png", "blocks.png", "pins.md"
PAGES = "steps", "report.html", "summary.json", "history.jsonl"


def laid_out(tmp_path, monkeypatch, die, **more):
    """(path of summary.json, limits broken) of the small die; more: further files."""
    monkeypatch.setattr(Options, "corners", ())  # a core without cells has no timing
    given = small.files(tmp_path) | more
    library = Runner(tmp_path / "shared", {})
    library.run(Library())
    given |= {f"library.{name}": library.paths[f"library.{name}"] for name in ("rules", "drc", "lvs")}
    for name in ("sdc", "verilog", *CORNERS):
        given[f"core.{name}"] = tmp_path / f"core.{name}"
        given[f"core.{name}"].write_text("")
    runner = Runner(tmp_path / "out" / "steps", given, print)
    return lay_out_die(DESIGNS["asp_chip"], Options(), runner, BLOCKS, die=die)


@pytest.mark.slow
@pytest.mark.timeout(3600)
def test_a_small_die_in_a_wrapper(tmp_path, monkeypatch):
    path, lines = laid_out(tmp_path, monkeypatch, None, wrapper=small.wrapper(tmp_path / "wrapper.gds"))
    summary = json.loads(path.read_text())
    assert lines == [] and summary["lvs_match"] and summary["drc_violations"] == summary["antenna_violations"] == 0
    assert summary["wrapper"] == CARAVAN.cell and summary["leads"] is None and summary["pads"] > 27
    assert any("have no ESD clamp" in line for line in summary["not_checked"])
    out = tmp_path / "out"
    named = {f"asp_sensor.{suffix}" for suffix in RESULTS}
    assert {file.name for file in out.iterdir()} == {*PAGES, "shuttle"} | named
    files = {str(file.relative_to(out / "shuttle")) for file in (out / "shuttle").rglob("*") if file.is_file()}
    cell = CARAVAN.cell
    assert files == {f"gds/{cell}.gds", f"verilog/gl/{cell}.v", "verilog/rtl/user_defines.v"}
    assert (out / "shuttle" / "gds" / f"{cell}.gds").read_bytes() == (out / "asp_sensor.gds").read_bytes()
    assert broken(summary | {"open_nets": 1}, RULES) and not broken(summary | {"pad_drc_violations": None}, RULES)


@pytest.mark.slow
@pytest.mark.timeout(3600)
def test_a_small_die(tmp_path, monkeypatch):
    path, lines = laid_out(tmp_path, monkeypatch, DieParameters(4800.0, 5000.0, west=2))
    summary = json.loads(path.read_text())
    assert lines == [] and summary["lvs_match"] and summary["drc_violations"] == summary["antenna_violations"] == 0
    assert summary["equivalence"] is None and summary["gate_tests"] is None and summary["wns_ns"] is None
    assert summary["esd_clamps"] == summary["esd_core_clamps"] == 1
    assert summary["leads"] >= summary["pads"] and 0 < summary["bond_wire_mm"] <= 5
    assert summary["black_boxes"] == list(BLOCKS) and summary["routed"] == len(small.core_pins())
    present = {file.name for file in (tmp_path / "out").iterdir()}
    assert present == {
        *PAGES,
        *(f"asp_sensor.{suffix}" for suffix in (*RESULTS, "esd.json", "package.png", "package.svg")),
    }
    assert "insides of the black boxes" in (tmp_path / "out" / "report.html").read_text()
    for name, value in (
        ("open_nets", 1),
        ("shorts", 2),
        ("lvs_match", False),
        ("drc_violations", 1),
        ("antenna_violations", None),
        ("esd_core_v", 4.51),
        ("bond_wire_mm", 5.01),
        ("wns_ns", {"ss": -0.1}),
    ):
        assert [line.split(" ")[0] for line in broken(summary | {name: value}, RULES)] == [name]
