"""A small die from footprints to metal: every net is found again, and a fault that is planted in it."""

import json
import re
import subprocess
import sys
from dataclasses import replace

import pytest

from talbot.base.gds import read_gds
from talbot.base.paths import ROOT
from talbot.base.steps import StepError
from talbot.base.tools import finish
from talbot.flow.layout.sensor import arrange
from talbot.flow.layout.sensor.plan import CORE, ORIENTATIONS, SIGNALS, STEP_UM, SUPPLIES, DieParameters, NoRoom
from talbot.flow.layout.sensor.test import small
from talbot.models.parameters import ArrayParameters, ChipParameters, ParameterError
from talbot.pixels.blocks import AnalogSizes, blocks
from talbot.signoff.geometry.abstract import ports

pytestmark = pytest.mark.needs("layout")

EXTRA = "  PIN more\n    DIRECTION INPUT ;\n    PORT\n      LAYER met3 ;\n      RECT 0 390 1 391 ;\n    END\n  END more"


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """(files of a small die, its plan)."""
    folder = tmp_path_factory.mktemp("die")
    given = small.files(folder)
    given["metrics"] = small.plan(given, folder)
    return given, json.loads(given["die_plan.plan"].read_text())


def matched(made, tmp_path, change):
    """(metrics, report) of the comparison once ``change`` was called with the plan."""
    given, plan = made[0] | {}, json.loads(json.dumps(made[1]))
    change(plan)
    given["die_plan.plan"] = tmp_path / "plan.json"
    given["die_plan.plan"].write_text(json.dumps(plan))
    metrics = small.connectivity(given, tmp_path)
    return metrics, json.loads((tmp_path / "connectivity.json").read_text())


def test_every_net_is_found_again(made, tmp_path):
    metrics, report = matched(made, tmp_path, lambda plan: None)
    assert metrics == {"open_nets": 0, "shorts": 0, "lvs_match": True} and report == {"open": {}, "short": {}}
    assert made[0]["metrics"]["routed"] == len(small.core_pins())
    assert made[0]["metrics"]["abutted"] == 16 * 6 + 120 * 2 + 2 * 2
    assert made[0]["metrics"]["nets"] == made[0]["metrics"]["routed"] + made[0]["metrics"]["abutted"] + len(SUPPLIES)
    assert made[0]["metrics"]["pads"] == len(SIGNALS) + 4 + 4 * 6


def test_pads_of_signals_are_on_three_sides(made, tmp_path):
    """The host's first ones in the west, analog ones in the east, above the supplies; ways meet no trunk."""
    plan = made[1]
    sides = {place["name"].removeprefix("pad_"): place["side"] for place in plan["ring"] if place["nets"]}
    assert [net for net in SIGNALS if sides[net] == "west"] == list(SIGNALS[:2])
    assert {sides[net] for net in SIGNALS[2:]} == {"south"}
    for place in plan["ring"]:
        if place["name"].removeprefix("pad_") in SIGNALS[:2]:
            assert place["at"] > plan["channel"][1] and place["nets"]["vdd"] == "vdd"
    ways = [shape for shape in plan["shapes"] if shape[0] in SIGNALS[:2] and shape[1:3] == [70, 20]]
    assert min(min(right - left, top - bottom) for *_, left, bottom, right, top in ways) >= 300  # pins have less
    level = made[0] | {}
    small.plan(level, tmp_path, replace(small.DIE, trunk_pitch=25.0, height_um=0.0))
    plan = json.loads(level["die_plan.plan"].read_text())
    ends = [
        branch["end"] for net in SIGNALS[:2] for branch in plan["routes"][net]["branches"] if branch["block"] == "die"
    ]
    assert any(low < end < high for end in ends for low, high in [plan["channel"]])
    assert small.connectivity(level, tmp_path)["lvs_match"]
    with pytest.raises(StepError, match="ring: no room for the branches of 7 pads in the west"):
        small.plan(made[0] | {}, tmp_path, replace(small.DIE, west=7, bar_um=4.0))


@pytest.mark.parametrize("height", [1770.0, 1800.0, 1990.0])
def test_no_height_shorts_a_supply(made, tmp_path, height):
    """At any height pads are at other places beside the lines of the rows' supply."""
    given = made[0] | {}
    small.plan(given, tmp_path, replace(small.DIE, height_um=height))
    assert small.connectivity(given, tmp_path) == {"open_nets": 0, "shorts": 0, "lvs_match": True}


@pytest.mark.parametrize("way", ORIENTATIONS)
def test_the_chip_turned(made, tmp_path, monkeypatch, way):
    """In each orientation all nets are connected; the one that is chosen has the least wire length."""
    given = made[0] | {}
    monkeypatch.setattr(arrange, "ORIENTATIONS", {way: ORIENTATIONS[way]})
    metrics = small.plan(given, tmp_path)
    assert metrics["wire_um"] >= made[0]["metrics"]["wire_um"]
    assert json.loads(given["die_plan.plan"].read_text())["blocks"][CORE]["orientation"] == way
    assert small.connectivity(given, tmp_path)["lvs_match"]


def index(plan, net, layer):
    """Of the longest shape of a net on a GDS layer."""
    found = [
        (max(right - left, top - bottom), k)
        for k, (of, number, datatype, left, bottom, right, top) in enumerate(plan["shapes"])
        if of == net and (number, datatype) == (layer, 20)
    ]
    return max(found)[1]


def test_a_stub_has_the_width_of_its_metal(made):
    """The chip's LEF has a port's metal in pieces; one of them alone was a stub of 0.065 um."""
    _, plan = made
    boxes = [
        branch["box"] for route in plan["routes"].values() for branch in route["branches"] if branch["block"] == "core"
    ]
    assert len(boxes) > small.SPLIT and min(top - bottom for _, bottom, _, top in boxes) >= 300


@pytest.mark.parametrize("layer, net", [(70, "dac[3]"), (71, "tap[1]"), (70, "miso")])
def test_a_missing_wire_is_an_open_net(made, tmp_path, layer, net):
    metrics, report = matched(made, tmp_path, lambda plan: plan["shapes"].pop(index(plan, net, layer)))
    assert not metrics["lvs_match"] and metrics["shorts"] == 0 and list(report["open"]) == [net]


@pytest.mark.parametrize("net", ["vdd", "vssa"])
def test_a_supply_without_its_lines_is_an_open_net(made, tmp_path, net):
    """One line is not missed: the ring and the bars connect all others."""

    def change(plan):
        plan["shapes"] = [shape for shape in plan["shapes"] if shape[:2] != [net, 72]]

    metrics, report = matched(made, tmp_path, change)
    assert metrics["shorts"] == 0 and list(report["open"]) == [net]


def test_two_pads_swapped(made, tmp_path):
    """Pads of one cell: the nets of both are named."""

    def change(plan):
        one, other = (next(place for place in plan["ring"] if place["name"] == f"pad_{net}") for net in ("csn", "mosi"))
        one["at"], other["at"] = other["at"], one["at"]

    metrics, report = matched(made, tmp_path, change)
    assert not metrics["lvs_match"] and {"csn", "mosi"} <= set(", ".join(report["short"]).split(", "))


@pytest.mark.parametrize("lost", [0, 30])
def test_a_gap_in_the_ring(made, tmp_path, lost):
    """A pad behind a missing filler has its supplies from the other side of the ring, but not behind two."""

    def change(plan):
        sides = [place for place in plan["ring"] if place["side"] == "south"]
        sides.sort(key=lambda place: place["at"])
        pads = [k for k, place in enumerate(sides) if place["nets"]]
        for k in (pads[3] - 1, pads[4] - 1)[: 1 + bool(lost)]:
            plan["ring"].remove(sides[k])

    metrics, report = matched(made, tmp_path, change)
    assert metrics["lvs_match"] is False or not lost
    assert not lost or {"vddio", "vssio"} <= set(report["open"])


def test_a_missing_cut_is_an_open_net(made, tmp_path):
    def change(plan):
        plan["shapes"] = [shape for shape in plan["shapes"] if not (shape[0] == "busy" and shape[1:3] == [70, 44])]

    metrics, report = matched(made, tmp_path, change)
    assert metrics["open_nets"] == 1 and list(report["open"]) == ["busy"]


def test_metal_between_two_nets_is_a_short(made, tmp_path):
    def change(plan):
        one, other = (plan["shapes"][index(plan, net, 70)] for net in ("dac[3]", "hold"))
        left = max(one[3], other[3]) + 1000
        plan["shapes"].append(["", 70, 20, left, min(one[4], other[4]), left + 300, max(one[6], other[6])])

    metrics, report = matched(made, tmp_path, change)
    (nets,) = report["short"]
    assert metrics["shorts"] == 1 and {"dac[3]", "hold"} <= set(nets.split(", "))


def test_a_wire_over_metal_inside_a_block_is_a_short(made, tmp_path):
    def change(plan):
        left, bottom, *_ = plan["blocks"][CORE]["box"]
        box = plan["shapes"][index(plan, "row[0]", 71)][3:]
        strap = left + 50_000  # of vss, where the chip is as drawn or upside down
        assert plan["blocks"][CORE]["orientation"] in ("N", "FS")
        plan["shapes"].append(["row[0]", 71, 20, strap, bottom + 10_000, strap + 2000, bottom + 12_000])
        plan["shapes"].append(["row[0]", 70, 20, min(strap, box[0]), bottom + 10_900, strap + 2000, bottom + 11_300])
        for x in ((box[0] + box[2]) // 2, strap + 1000):
            plan["shapes"].append(["row[0]", 70, 44, x - 100, bottom + 11_000, x + 100, bottom + 11_200])

    metrics, report = matched(made, tmp_path, change)
    assert metrics["shorts"] == 1 and "row[0], vss" in report["short"]


def test_an_abutting_block_out_of_its_place(made, tmp_path):
    def change(plan):
        plan["blocks"]["row_driver"]["box"][1] += 800

    metrics, report = matched(made, tmp_path, change)
    assert metrics["open_nets"] > 16 * 6 and "read_row[3]" in report["open"]


def test_the_diode_lines_of_a_lane_swapped(made, tmp_path):
    """The converters' block has them at each other's places."""
    layout, other = read_gds(made[0]["adc_lanes.gds"]), {"lane_a[1]": "lane_b[1]", "lane_b[1]": "lane_a[1]"}
    for index in layout.layer_indexes():
        for shape in layout.top_cell().shapes(index).each():
            if shape.is_text() and shape.text_string in other:
                shape.text_string = other[shape.text_string]
    layout.write(str(tmp_path / "lanes.gds"))
    metrics = small.connectivity(made[0] | {"adc_lanes.gds": tmp_path / "lanes.gds"}, tmp_path)
    report = json.loads((tmp_path / "connectivity.json").read_text())
    assert not metrics["lvs_match"] and list(report["short"]) == ["lane_a[1], lane_b[1]"]


def test_a_row_line_cut(made, tmp_path):
    """The line's metal at the row driver's edge is gone; its name is left."""
    layout = read_gds(made[0]["row_driver.gds"])
    cell = layout.top_cell()
    for index in layout.layer_indexes():
        shapes = cell.shapes(index)
        names = [
            shape.text_trans.disp for shape in shapes.each() if shape.is_text() and shape.text_string == "read_row[3]"
        ]
        metal = layout.find_layer(layout.get_info(index).layer, 20)
        for at in names:
            for shape in [one for one in cell.shapes(metal).each() if one.is_box()]:
                if shape.bbox().contains(at.to_p()):
                    shape.delete()
    layout.write(str(tmp_path / "driver.gds"))
    given = made[0] | {"row_driver.gds": tmp_path / "driver.gds"}
    small.connectivity(given, tmp_path)
    report = json.loads((tmp_path / "connectivity.json").read_text())
    assert list(report["open"]) == ["read_row[3]"] and not report["short"]


def test_blocks_that_the_die_has_no_room_for(made, tmp_path):
    with pytest.raises(ParameterError, match=r"height_um = 900: must be at least \d+"):
        small.plan(made[0] | {}, tmp_path, DieParameters(2800.0, 900.0))
    for height in (1800.0, 0.0):  # a width that is given does not grow with a height that is not
        with pytest.raises(NoRoom, match="ring: no room for the pad of "):
            small.plan(made[0] | {}, tmp_path, DieParameters(2050.0, height, west=0))


@pytest.mark.parametrize(
    "rows, cols, pitch, lanes, room",
    [(7, 150, 10e-6, 1, None), (60, 131, 10e-6, 2, 60.0), (200, 190, 12.5e-6, 4, None)],
)
def test_a_die_of_any_sensor_has_the_least_size(tmp_path, rows, cols, pitch, lanes, room):
    """The chip is below the column amplifiers, or west of the row driver where these are too narrow."""
    array, chip = ArrayParameters(rows, cols, pitch), ChipParameters(lanes)
    given = small.files(tmp_path, blocks(array, chip, AnalogSizes(chip_um=room) if room else None))
    small.plan(given, tmp_path, DieParameters())
    assert small.connectivity(given, tmp_path) == {"open_nets": 0, "shorts": 0, "lvs_match": True}
    plan = json.loads(given["die_plan.plan"].read_text())
    width, height = (side / 1000 for side in plan["die"])
    chip_at, drivers = plan["blocks"][CORE]["box"], plan["blocks"]["row_driver"]["box"]
    assert (chip_at[2] > drivers[2]) == (room is None)
    for smaller in (
        replace(DieParameters(), width_um=width - STEP_UM, height_um=height, pad_um=100.0),
        replace(DieParameters(), width_um=width, height_um=height - STEP_UM, pad_um=100.0),
    ):
        with pytest.raises(NoRoom):
            small.plan(given, tmp_path, smaller)


@pytest.mark.parametrize(
    "change, words",
    [
        (lambda text: text.replace("END busy", "END busy\n" + EXTRA), "more = a pin of core alone"),
        (
            lambda text: re.sub(r"(?s)  PIN unsigned_\n.*?END unsigned_\n", "", text),
            "unsigned_ = a pin of adc_lanes alone: must be one",
        ),
        (lambda text: text.replace("busy", "bussy"), "busy = a pin of die alone"),
        (
            lambda text: text.replace(
                "PIN comparator[0]\n    DIRECTION INPUT", "PIN comparator[0]\n    DIRECTION OUTPUT"
            ),
            "comparator[0] = driven by adc_lanes, core: must have one driver",
        ),
        (
            lambda text: text.replace("PIN hold\n    DIRECTION OUTPUT", "PIN hold\n    DIRECTION INPUT"),
            "hold = driven by nothing: must have one driver",
        ),
    ],
)
def test_pins_that_fit_nothing(made, tmp_path, change, words):
    given = made[0] | {f"{CORE}.lef": tmp_path / "core.lef"}
    given[f"{CORE}.lef"].write_text(change(made[0][f"{CORE}.lef"].read_text()))
    with pytest.raises(ParameterError, match=re.escape(words)):
        small.plan(given, tmp_path)


def test_a_pin_behind_a_block(made, tmp_path):
    text = made[0]["column_amplifiers.lef"].read_text()
    found = re.search(r"PIN mode\[0\]\n.*?RECT (\S+) (\S+) (\S+) (\S+)", text, re.S)
    lanes = next(block for block in small.ANALOG if block.name == "column_amplifiers")
    west = max(pin.at_um for pin in lanes.pins if pin.name.startswith("lane_"))
    moved = text.replace(
        f"RECT {' '.join(found.groups())}", f"RECT {west + 9:.3f} {found[2]} {west + 9.4:.3f} {found[4]}"
    )
    given = made[0] | {"column_amplifiers.lef": tmp_path / "columns.lef"}
    given["column_amplifiers.lef"].write_text(moved)
    with pytest.raises(StepError, match=r"column_amplifiers: its pin mode\[0\] has adc_lanes in its way to the south"):
        small.plan(given, tmp_path)


def test_a_supply_that_does_not_reach_its_side(made, tmp_path):
    text = made[0]["adc_lanes.lef"].read_text()
    given = made[0] | {"adc_lanes.lef": tmp_path / "lanes.lef"}
    found = re.search(r"PIN vssa\n.*?RECT (\S+ \S+) (\S+) (\S+)", text, re.S)
    given["adc_lanes.lef"].write_text(
        text.replace(f"{found[1]} {found[2]} {found[3]}", f"{found[1]} {float(found[2]) - 1} {found[3]}")
    )
    with pytest.raises(StepError, match="adc_lanes: its pin vssa reaches neither its west nor its east side on met5"):
        small.plan(given, tmp_path)


def test_verilog_joins_every_port_of_the_chip(made, tmp_path):
    """The chip's own Verilog in place of the small core: ports of the same names and widths, checked by Yosys."""
    subprocess.run(
        [
            sys.executable,
            "-m",
            "talbot.rtl.export",
            "--top",
            "AspChip",
            "--out",
            tmp_path,
            "--rows=16",
            "--cols=120",
            "--lanes=2",
        ],
        cwd=ROOT,
        check=True,
        capture_output=True,
    )
    chip = tmp_path / "AspChip.sv"
    text = made[0]["die_plan.verilog"].read_text().replace("Core core", "AspChip core")
    top = tmp_path / "top.v"
    top.write_text(text)
    module = text[text.index("module asp_sensor") :]
    (joined,) = re.findall(r"AspChip core \((.*)\);", module)
    names = set(re.findall(r"\.(\w+)\(\1\)", joined))
    source = chip.read_text()
    head = source[source.rindex("module AspChip\n") :]
    own = set(
        re.findall(r"(?m)^\s*(?:input|output)\s+(?:logic|wire|reg)?\s*(?:\[\S+\])?\s*(\w+)", head[: head.index(");")])
    )
    assert len(own) == 36 and names == own
    assert {block.name for block in blocks()} == set(re.findall(r"(?m)^  (\w+) \1 \(", module))
    said = finish(["yosys", "-q", "-p", f"read_verilog -sv {chip} {top}; hierarchy -check -top asp_sensor"])
    assert said.returncode == 0 and "Warning: Resizing" not in said.stdout + said.stderr, said.stderr
    assert ports(module)["miso"] == "output"
