"""A user's analog blocks in place of the black boxes: used when they fit, refused in one line when they do not."""

import json
import re
import shutil

import pytest

from talbot.base.steps import Runner, StepError
from talbot.flow.layout.sensor.analog import files
from talbot.flow.layout.sensor.plan import BLOCKS, DieParameters
from talbot.flow.layout.sensor.steps.die_antenna import DieAntenna
from talbot.flow.layout.sensor.steps.die_drc import DieDrc
from talbot.flow.layout.sensor.steps.die_pads import DiePads
from talbot.flow.layout.sensor.steps.drawing import DrawingParameters, DrawnCircuits, DrawnPixels
from talbot.flow.layout.sensor.test import small
from talbot.flow.layout.steps.library import Library
from talbot.flow.layout.steps.parameters import PdkParameters
from talbot.models.parameters import ParameterError
from talbot.models.parameters.sensor_file import sensor_of
from talbot.pixels.blocks import blocks
from talbot.platforms.layout import layout_platform
from talbot.platforms.pads import pad_process
from talbot.signoff.black_box import extra_pins

pytestmark = pytest.mark.needs("layout")
DRAWINGS = DrawnPixels, DrawnCircuits


@pytest.fixture(scope="module")
def black_boxes(tmp_path_factory):
    """Folder with the black boxes of the whole sensor."""
    folder = tmp_path_factory.mktemp("black_boxes")
    found, drawn = files(folder, "sky130")
    assert drawn == BLOCKS
    assert found == {f"{block}.black_box": folder / f"{block}.lef" for block in BLOCKS}
    return folder


def theirs(black_boxes, folder, block, change=lambda text: text):
    for kind in ("lef", "gds"):
        shutil.copyfile(black_boxes / f"{block}.{kind}", folder / f"{block}.{kind}")
    path = folder / f"{block}.lef"
    path.write_text(change(path.read_text()))


def with_reference(text):
    """The LEF with a pin that its black box does not have."""
    return text.replace(
        "  PIN clk\n",
        "  PIN vref\n    DIRECTION INPUT ;\n    PORT\n      LAYER met4 ;\n"
        "        RECT 1.8 0 2.2 2 ;\n    END\n  END vref\n  PIN clk\n",
    )


def test_a_block_takes_the_place_of_its_black_box(black_boxes, tmp_path):
    theirs(black_boxes, tmp_path, "adc_lanes", with_reference)
    found, drawn = files(tmp_path / "out", "sky130", tmp_path)
    assert found["adc_lanes.lef"].parent == found["adc_lanes.gds"].parent == tmp_path
    assert drawn == ("pixel_array", "row_driver", "column_amplifiers")
    assert extra_pins(found["adc_lanes.lef"], found["adc_lanes.black_box"]) == ["vref"]
    theirs(black_boxes, tmp_path, "pixel_array")
    found, drawn = files(tmp_path / "out", "sky130", tmp_path)
    assert found["pixel_array.gds"].parent == tmp_path and "pixel_array" not in drawn


@pytest.mark.slow
@pytest.mark.timeout(1200)
def test_every_block_that_is_drawn_is_on_the_die(black_boxes, tmp_path):
    references = {"dark", "reference", "start", "start_a", "level", "vbp", "vcp", "vcn", "vbl", "ibias_columns"}
    extra = set()
    for step in (DrawnPixels(), DrawnCircuits()):
        runner = Runner(tmp_path, {})
        runner.run(step)
        for name in (name for name in step.outputs if name.endswith(".lef")):
            extra |= set(extra_pins(runner.paths[f"{step.name}.{name}"], black_boxes / name))
    assert extra == {"refp", "refn", "vcm", "vref"} | references


@pytest.mark.parametrize(
    "change, words",
    [
        (lambda text: re.sub(r"(?s)  PIN dac\[7\]\n.*?END dac\[7\]\n", "", text), "must have the pins dac[7]"),
        (lambda text: re.sub(r"(?s)  PIN dac\[\d+\]\n.*?END dac\[\d+\]\n", "", text), "dac[4] and 59 more"),
        (
            lambda text: text.replace("PIN hold\n    DIRECTION INPUT", "PIN hold\n    DIRECTION OUTPUT"),
            "its pin hold must be of DIRECTION INPUT",
        ),
        (lambda text: re.sub(r"(?s)PIN hold\n.*?RECT [^\n]*\n", "PIN hold\n", text, count=1), "pin hold: must have a"),
    ],
)
def test_other_pins(black_boxes, tmp_path, change, words):
    theirs(black_boxes, tmp_path, "adc_lanes", change)
    with pytest.raises(ParameterError, match=re.escape(words)):
        extra_pins(tmp_path / "adc_lanes.lef", black_boxes / "adc_lanes.lef")


def test_missing_files(black_boxes, tmp_path):
    folder = tmp_path / "mine"

    def refused(words):
        with pytest.raises(ParameterError, match=words):
            files(tmp_path / "out", "sky130", folder)

    refused("mine: no such folder")
    folder.mkdir()
    refused("must have <block>.lef and <block>.gds of pixel_array, row_driver")
    theirs(black_boxes, folder, "row_driver")
    (folder / "row_driver.gds").unlink()
    refused("mine: must have row_driver.gds")
    assert not (tmp_path / "out").exists()


def test_a_pin_of_its_own_is_one_of_the_die(tmp_path):
    import klayout.db as db

    given = small.files(tmp_path)
    path = given["adc_lanes.lef"]
    path.write_text(with_reference(path.read_text()))
    assert small.plan(given, tmp_path)["routed"] == len(small.core_pins()) + 1
    assert "input vref;" in given["die_plan.verilog"].read_text()
    assert small.connectivity(given, tmp_path)["open_nets"] == 1  # its GDS does not have the pin yet
    layout = db.Layout()
    layout.read(str(given["adc_lanes.gds"]))
    cell, wire = layout.cell("adc_lanes"), layout_platform("sky130").metals[4]
    inner = layout.create_cell("Core")  # as the chip's: two cells of one name are not one
    inner.shapes(layout.layer(*wire.gds)).insert(db.DBox(1.8, 0, 2.2, 2))
    cell.insert(db.CellInstArray(inner.cell_index(), db.Trans()))
    cell.shapes(layout.layer(wire.layer, 16)).insert(db.DText("vref", 2, 1))
    layout.write(str(given["adc_lanes.gds"]))
    assert small.connectivity(given, tmp_path)["lvs_match"]
    layout.rename_cell(cell.cell_index(), "adc")
    layout.write(str(given["adc_lanes.gds"]))
    with pytest.raises(StepError, match="adc_lanes.gds has the top cells adc; its LEF is of adc_lanes"):
        small.connectivity(given, tmp_path)


def test_what_an_analog_block_drives_has_an_analog_pad(tmp_path):
    given = small.files(tmp_path)
    path = given["adc_lanes.lef"]
    text = with_reference(path.read_text())
    path.write_text(text.replace("PIN vref\n    DIRECTION INPUT", "PIN vref\n    DIRECTION OUTPUT"))
    small.plan(given, tmp_path)
    ring = json.loads(given["die_plan.plan"].read_text())["ring"]
    (cell,) = (place["cell"] for place in ring if place["name"] == "pad_vref")
    assert cell == pad_process("sky130").signals["analog"]
    assert "output vref;" in given["die_plan.verilog"].read_text()


def test_the_drawn_array_is_a_block_of_the_die(tmp_path):
    """Every net of a small die is found again with the drawn array in it; pixels alone are left out of the rules."""
    import klayout.db as db

    from talbot.pixels.layout.write import array_layout, write

    given = small.files(tmp_path)
    write(tmp_path, array_layout("sky130", 16, 120))
    plain = small.plan(given, tmp_path)
    assert plain["abutted"] == 16 * 6 + 120 * 2 + 2 * 2
    metrics = small.connectivity(given, tmp_path, drawn=("pixel_array",))
    assert metrics == {"open_nets": 0, "shorts": 0, "lvs_match": True}

    def cells(name):
        layout = db.Layout()
        layout.read(str(given[f"die_gds.{name}"]))
        return {cell.name for cell in layout.each_cell()}

    lacking = cells("gds") - cells("checked") - {"seal_ring", "seal_ring_contact"}
    assert len(lacking) == 24 and all(name.startswith("pixel_") for name in lacking)
    assert {"pixel_array", "row_end", "column_end", "supply_end"} <= cells("checked")


def test_the_drawn_rows_are_a_block_of_the_die(tmp_path):
    """Supplies of three levels, every line and control are found again where rows and array are drawn."""
    from talbot.base.gds import write_gds
    from talbot.models.parameters import ArrayParameters, ChipParameters
    from talbot.pixels.analog_layout.row_drivers import draw_row_drivers
    from talbot.pixels.blocks import AnalogSizes, blocks
    from talbot.pixels.footprints import write
    from talbot.platforms.analog import analog_masks

    given, masks = small.files(tmp_path), analog_masks("sky130")
    sizes = AnalogSizes(columns_um=200.0, lane_um=100.0, chip_um=360.0)
    columns = next(
        one for one in blocks(ArrayParameters(16, 120), ChipParameters(2), sizes) if one.name == "column_amplifiers"
    )
    write(tmp_path, [columns], "sky130", sizes.supply_um)
    made = draw_row_drivers(masks, ArrayParameters(16, 120))
    lef = tmp_path / "drawn.lef"
    lef.write_text(made.lef(masks))
    assert extra_pins(lef, given["row_driver.lef"]) == []
    given["row_driver.lef"].write_text(made.lef(masks))
    write_gds(made.layout, given["row_driver.gds"], made.cell)
    assert (
        small.plan(given, tmp_path, DieParameters(2960.0, 1800.0, pad_um=91.0, side_um=91.0, west=2))["abutted"]
        == 16 * 6 + 120 * 2 + 2 * 2
    )
    assert small.connectivity(given, tmp_path) == {"open_nets": 0, "shorts": 0, "lvs_match": True}


@pytest.mark.slow
def test_the_drawn_blocks_of_another_sensor_are_a_die(tmp_path):
    """Another array, pitch and number of lanes, the real pads, and a stand-in for the chip: no rule is broken."""
    sensor = sensor_of({"array": {"rows": 48, "cols": 176, "pitch": 12e-6}, "chip": {"lanes": 4}})
    given = small.files(tmp_path, blocks(sensor.array, sensor.chip))
    library = Library(PdkParameters())
    for step in (library, DiePads(PdkParameters()), *(kind(DrawingParameters("sky130", sensor)) for kind in DRAWINGS)):
        (tmp_path / step.name / "part").mkdir(parents=True)
        outputs = {name: tmp_path / step.name / "part" / file for name, file in step.outputs.items()}
        step.run({}, outputs)
        given |= {f"{step.name}.{name}": path for name, path in outputs.items()}
        if step.name.startswith("drawn"):
            given |= outputs
    small.plan(given, tmp_path, DieParameters())
    plan = json.loads(given["die_plan.plan"].read_text())
    assert plan["die"] == [3_200_000, 2_440_000]
    assert small.connectivity(given, tmp_path, drawn=BLOCKS) == {"open_nets": 0, "shorts": 0, "lvs_match": True}
    assert small.run(DieAntenna(PdkParameters()), given, tmp_path)["antenna_violations"] == 0
    assert small.run(DieDrc(PdkParameters()), given, tmp_path)["drc_violations"] == 0
