"""A small die in a shuttle's wrapper: every pin is on its net, whatever the wrapper's size; faults are found."""

import json
import re

import pytest

from talbot.base.gds import write_gds
from talbot.flow.layout.sensor.plan import SIGNALS, NoRoom
from talbot.flow.layout.sensor.steps.die_connectivity import DieConnectivity
from talbot.flow.layout.sensor.steps.die_gds import DieGdsParameters
from talbot.flow.layout.sensor.steps.die_plan import DiePlanParameters
from talbot.flow.layout.sensor.steps.wrapped import WrappedGds, WrappedPlan
from talbot.flow.layout.sensor.test import small
from talbot.flow.layout.sensor.wrapper import check_wrapper
from talbot.flow.layout.steps.parameters import PdkParameters
from talbot.models.parameters import ParameterError
from talbot.platforms.layout import layout_platform
from talbot.platforms.sky130.chipignite import BARE, BIASES, CARAVAN, GPIO, INPUTS, OUTPUTS, defines

pytestmark = pytest.mark.needs("layout")


@pytest.fixture(scope="module")
def wrapped(tmp_path_factory):
    """(files of a small die in a wrapper, its plan, metrics)."""
    folder = tmp_path_factory.mktemp("wrapped")
    given = small.files(folder)
    given["wrapper"] = small.wrapper(folder / "wrapper.gds")
    metrics = small.run(WrappedPlan(DiePlanParameters()), given, folder)
    return given, json.loads(given["die_plan.plan"].read_text()), metrics


def connected(given, folder):
    small.run(WrappedGds(DieGdsParameters()), given, folder)
    return small.run(DieConnectivity(PdkParameters()), given, folder)


def test_every_pin_is_on_its_net(wrapped, tmp_path):
    given, plan, metrics = wrapped
    assert connected(given | {}, tmp_path) == {"open_nets": 0, "shorts": 0, "lvs_match": True}
    assert metrics["pads"] == sum(block == "die" for ends in plan["nets"].values() for block, _ in ends)
    on = {pin: net for net, ends in plan["nets"].items() for block, pin in ends if block == "die"}
    for k in range(GPIO):  # an input's and an unused driver is off and low, an output's is on
        drives = k in OUTPUTS.values()
        assert on[f"io_oeb[{k}]"] in (("vss", "vssa") if drives else ("vdd", "vddc"))
        assert on[f"io_out[{k}]"] in (OUTPUTS if drives else ("vss", "vssa"))
    assert {on[f"io_in[{k}]"] for k in INPUTS.values()} == set(INPUTS)
    (spare,) = (net for pin, net in on.items() if pin.startswith("la_data_out"))
    assert spare == "miso_oe" and {*INPUTS, *OUTPUTS, spare} == set(SIGNALS)
    lines = given["die_plan.pins"].read_text().splitlines()
    assert "| io_in[14] | clk |" in lines and len([line for line in lines if line.startswith("| ")]) == len(on) + 1


@pytest.mark.parametrize("name", ["io_oeb[14]", "io_out[22]", "vccd2", "vssa1", "la_data_out[0]"])
def test_a_pin_without_its_metal_is_open(wrapped, tmp_path, name):
    """Without the shapes that touch a pin, its net is open and no other."""
    import klayout.db as db

    given, plan, _ = wrapped
    given = given | {"die_plan.plan": tmp_path / "plan.json"}
    (net,) = (net for net, ends in plan["nets"].items() if ["die", name] in ends)
    top = db.Layout()
    top.read(str(given["wrapper"]))
    texts = top.top_cell().shapes(top.layer(69 if name.startswith("la") else 70, 16))
    at = [shape.text.position() for shape in texts.each() if shape.is_text() and shape.text.string == name]
    touched = [
        shape
        for shape in plan["shapes"]
        if shape[0] == net
        and shape[1] in (69, 70)
        and any(db.Box(*shape[3:]).enlarged(2500, 2500).contains(p) for p in at)
    ]
    assert touched
    rest = [shape for shape in plan["shapes"] if shape not in touched]
    given["die_plan.plan"].write_text(json.dumps(plan | {"shapes": rest}))
    assert not connected(given, tmp_path)["lvs_match"]
    assert list(json.loads((tmp_path / "connectivity.json").read_text())["open"]) == [net]


@pytest.mark.parametrize("width, height", [(2760.0, 1850.0), (3001.0, 2003.0), (2920.0, 1950.0)])
def test_other_outlines(wrapped, tmp_path, width, height):
    """At other heights pins are level with the channel: in the order of its tracks none meets another's stub."""
    given = wrapped[0] | {"wrapper": small.wrapper(tmp_path / "wrapper.gds", width, height)}
    small.run(WrappedPlan(DiePlanParameters()), given, tmp_path)
    plan = json.loads(given["die_plan.plan"].read_text())
    low, high = plan["channel"]
    sideways = [b for route in plan["routes"].values() for b in route["branches"] if b["side"] in ("west", "east")]
    assert any(low < branch["end"] < high for branch in sideways)
    assert connected(given, tmp_path) == {"open_nets": 0, "shorts": 0, "lvs_match": True}


def test_what_does_not_fit_is_refused(wrapped, tmp_path):
    given = wrapped[0] | {"wrapper": small.wrapper(tmp_path / "small.gds", 2700.0, 900.0)}
    with pytest.raises(NoRoom, match="height_um = 900: must be at least"):
        small.run(WrappedPlan(DiePlanParameters()), given, tmp_path)
    with pytest.raises(ParameterError, match="wrapper = other.gds with the top cells other: must be user_analog"):
        check_wrapper(small.wrapper(tmp_path / "other.gds", cell="other"), "sky130")
    with pytest.raises(ParameterError, match="no such file"):
        check_wrapper(tmp_path / "none.gds", "sky130")
    (tmp_path / "text.gds").write_text("no GDS")
    with pytest.raises(ParameterError, match="text.gds: must be GDS"):
        check_wrapper(tmp_path / "text.gds", "sky130")
    empty = tmp_path / "empty.gds"
    import klayout.db as db

    layout = db.Layout()
    layout.create_cell(CARAVAN.cell)
    write_gds(layout, empty)
    with pytest.raises(ParameterError, match="must have an outline, and pins with their names"):
        check_wrapper(empty, "sky130")


def test_references_reach_the_north_and_others_a_spare_pin(wrapped, tmp_path):
    """A user's analog block may have pins of other names."""
    import klayout.db as db

    given = wrapped[0] | {f"adc_lanes.{kind}": tmp_path / f"lanes.{kind}" for kind in ("lef", "gds")}
    names, metal = [*BARE[1:], *BIASES, "more"], layout_platform("sky130").metals[4]
    lef, layout = wrapped[0]["adc_lanes.lef"].read_text(), db.Layout()
    layout.read(str(wrapped[0]["adc_lanes.gds"]))
    (lanes,) = (block for block in small.ANALOG if block.name == "adc_lanes")
    taken = [pin.at_um for pin in lanes.pins if pin.side == "south"]
    free = (x for x in range(3, 200, 2) if all(abs(x - other) > 1.5 for other in taken))
    for name, x in zip(names, free, strict=False):
        box = x - 0.2, 0.0, x + 0.2, 2.0
        at = " ".join(map(str, box))
        pin = f"  PIN {name}\n    DIRECTION INPUT ;\n    PORT\n      LAYER met4 ;\n        RECT {at} ;"
        lef = lef.replace("  PIN clk\n", f"{pin}\n    END\n  END {name}\n  PIN clk\n", 1)
        cell = layout.cell("adc_lanes")
        cell.shapes(layout.layer(*metal.gds)).insert(db.DBox(*box))
        cell.shapes(layout.layer(*metal.pin)).insert(db.DText(name, x, 1.0))
    given["adc_lanes.lef"].write_text(lef)
    layout.write(str(given["adc_lanes.gds"]))
    small.run(WrappedPlan(DiePlanParameters()), given, tmp_path)
    nets = json.loads(given["die_plan.plan"].read_text())["nets"]
    for k, name in enumerate(BARE[1:], 1):
        assert nets[name] == [["die", f"io_analog[{k}]"], ["adc_lanes", name]]
    assert nets["vbp"][0] == ["die", f"gpio_noesd[{BIASES['vbp']}]"] and nets["more"][0][1].startswith("la_data_out")
    assert connected(given, tmp_path) == {"open_nets": 0, "shorts": 0, "lvs_match": True}


def test_verilog_has_all_ports(wrapped, tmp_path):
    """Icarus or Verilator is not needed: names and widths are those of the pins."""
    text = wrapped[0]["die_plan.verilog"].read_text()
    head = text[text.index(f"module {CARAVAN.cell}") :]
    assert "input [26:0] io_in;" in head and "output [26:0] io_oeb;" in head and "vccd1" not in head
    assert ".clk({io_in[14]})" in head and ".miso_oe({la_data_out[0]})" in head
    assert re.search(r"\.link_data\(\{io_out\[7\], io_out\[6\], io_out\[5\], io_out\[26\],", head)
    assert "assign io_oeb[14] = 1'b1;" in head and "assign io_oeb[19] = 1'b0;" in head


def test_configuration_of_the_pads():
    lines = dict(re.findall(r"`define (USER_CONFIG_GPIO_\d+_INIT) (\S+)", defines()))
    assert lines["USER_CONFIG_GPIO_25_INIT"] == "13'h0402"  # GPIO 14 of the user area: clk
    assert lines["USER_CONFIG_GPIO_8_INIT"] == "13'h1808" and lines["USER_CONFIG_GPIO_10_INIT"] == "13'h000a"
    assert sorted(int(name.split("_")[3]) for name in lines) == [*range(5, 14), *range(25, 38)]
