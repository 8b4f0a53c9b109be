"""Loads and delays of the die's nets, and the chip's timing with them."""

import json
import re

import pytest

from talbot.flow.layout.sensor import coupling, elmore
from talbot.flow.layout.sensor.elmore import delays
from talbot.flow.layout.sensor.routing import STUB
from talbot.flow.layout.sensor.steps.die_antenna import DieAntenna
from talbot.flow.layout.sensor.steps.die_parasitics import DieParasitics, DieParasiticsParameters
from talbot.flow.layout.sensor.steps.die_sta import over
from talbot.flow.layout.sensor.test import small
from talbot.flow.layout.steps.parameters import PdkParameters
from talbot.platforms.extraction import extraction_platform
from talbot.platforms.layout import layout_platform

pytestmark = pytest.mark.needs("layout")


def test_elmore_by_hand():
    """a -1k- b -2k- c, b -3k- d; 10 fF at c, 20 fF at d, 4 fF of the first wire."""
    edges = [("a", "b", 1000.0, 4.0), ("b", "c", 2000.0, 0.0), ("d", "b", 3000.0, 0.0)]
    found = delays(edges, "a", {"c": 10.0, "d": 20.0})
    assert found == pytest.approx({"a": 0.0, "b": 0.032, "c": 0.052, "d": 0.092})
    assert delays(edges, "d", {"a": 5.0})["a"] == pytest.approx(3000 * 9e-6 + 1000 * 7e-6)


@pytest.fixture(scope="module")
def parasitics(tmp_path_factory):
    """(metrics, nets, SDC, plan) of the small die."""
    folder = tmp_path_factory.mktemp("parasitics")
    given = small.files(folder)
    small.plan(given, folder)
    given["core.sdc"] = folder / "core.sdc"
    given["core.sdc"].write_text("create_clock -name clk -period 20 [get_ports {clk}]\n")
    metrics = small.run(
        DieParasitics(DieParasiticsParameters(pin_pf=0.03, load_pf=0.0, input_ns=3.0, output_ns=5.0)), given, folder
    )
    return (
        metrics,
        json.loads(given["die_parasitics.nets"].read_text()),
        given["die_parasitics.sdc"].read_text(),
        json.loads(given["die_plan.plan"].read_text()),
    )


def test_a_net_by_hand(parasitics):
    """tap[0]: from the chip to the row driver and the column amplifiers; more than its area and edges alone."""
    _, nets, _, plan = parasitics
    tech, tracks, route = layout_platform("sky130"), plan["tracks"], plan["routes"]["tap[0]"]
    assert len(route["branches"]) == 3 and nets["tap[0]"]["driver"] == "core"
    xs = [branch["x"] for branch in route["branches"]]
    (core,) = [branch for branch in route["branches"] if branch["block"] == "core"]
    left, bottom, right, top = core["box"]
    pieces = (
        (3, tracks["trunk"], max(xs) - min(xs)),
        (4, tracks["branch"], sum(abs(branch["end"] - route["y"]) for branch in route["branches"])),
        (STUB, top - bottom, max(left - core["x"], core["x"] - right)),
    )
    alone = sum(
        length * 1e-6 * (width / 1000 * tech.metals[level].area_af_um2 + 2 * tech.metals[level].fringe_af_um)
        for level, width, length in pieces
    )
    assert alone < nets["tap[0]"]["wire_ff"] < 3 * alone
    assert nets["tap[0]"]["load_pf"] == pytest.approx(nets["tap[0]"]["wire_ff"] / 1000 + 0.06, abs=1e-5)
    slow, quick = nets["tap[0]"]["delay_ns"].values()
    assert min(slow, quick) > 0 and set(nets["tap[0]"]["delay_ns"]) == {"row_driver.tap[0]", "column_amplifiers.tap[0]"}


def test_a_pad_in_the_west_has_a_stub(parasitics):
    """clk: without the resistance of its stub it is quicker."""
    plan, tech = parasitics[3], layout_platform("sky130")
    route = plan["routes"]["clk"]
    (pad,) = [branch for branch in route["branches"] if branch["block"] == "die"]
    assert pad["side"] == "west" and pad["x"] > pad["box"][2]
    near = [branch | {"box": [0, 0, pad["x"], 600]} if branch is pad else branch for branch in route["branches"]]
    whole, without = (
        elmore.net(found, route["y"], ("die", "clk"), plan["tracks"], tech, 0.01, 100.0)
        for found in (route["branches"], near)
    )
    assert all(whole[end] > without[end] for end in whole) and ("core", "clk") in whole


def test_delays_follow_the_capacitance(parasitics):
    """Twice the capacitance of the segments and no pins: twice the delay."""
    plan, tech = parasitics[3], layout_platform("sky130")
    route = plan["routes"]["tap[0]"]
    one, two = (
        elmore.net(route["branches"], route["y"], ("core", "tap[0]"), plan["tracks"], tech, 0.0, femto)
        for femto in (100.0, 200.0)
    )
    assert two == pytest.approx({end: 2 * ns for end, ns in one.items()})


@pytest.mark.parametrize("near, far", [(400, 4000)])
def test_a_neighbour_couples(near, far):
    """Two long wires of the trunks' metal beside each other; alone one has what Wires give to the substrate."""
    tech = layout_platform("sky130")
    layer = tech.metals[3].gds
    found = {}
    for apart in (near, far, 50_000):
        shapes = [[net, *layer, 0, y, 500_000, y + 300] for net, y in (("a", 0), ("b", 300 + apart))]
        plan = {"shapes": shapes, "routes": {"a": None, "b": None}}
        both = coupling.femtofarads(plan, tech, extraction_platform("sky130"))
        assert both["a"] == pytest.approx(both["b"], rel=1e-6)
        found[apart] = both["a"]
    assert found[near] > 1.2 * found[far] > found[50_000] > 0


def test_constraints_have_every_port_once(parasitics):
    metrics, nets, sdc, _ = parasitics
    assert sdc.startswith("create_clock")
    loads = {name: float(load) for load, name in re.findall(r"set_load (\S+) \[get_ports \{(.*?)\}\]", sdc)}
    assert loads == {net: found["load_pf"] for net, found in nets.items() if found["driver"] == "core"}
    late = {
        name: float(ns)
        for ns, name in re.findall(r"set_output_delay (\S+) -max -clock clk \[get_ports \{(.*?)\}\]", sdc)
    }
    early = {
        name: float(ns)
        for ns, name in re.findall(r"set_input_delay (\S+) -max -clock clk \[get_ports \{(.*?)\}\]", sdc)
    }
    assert set(late) | set(early) == set(small.core_pins()) - {"clk"} and not set(late) & set(early)
    assert late["hold"] == pytest.approx(5 + max(nets["hold"]["delay_ns"].values()), abs=1e-5)
    wire = nets["comparator[1]"]["delay_ns"]["core.comparator[1]"]
    assert early["comparator[1]"] == pytest.approx(3 + wire, abs=1e-5)
    assert metrics["worst_load_pf"] == round(max(loads.values()), 4) and metrics["loads_over"] == len(loads)


def test_slews_that_openSTA_tells_of():
    said = (
        "WORST hold 1\nmax slew\n\nPin  Limit Slew Slack\n---\nu1/q    1.50    2.96   -1.46 (VIOLATED)\n"
        "row[1]_reg/q    1.50    1.54   -0.04 (VIOLATED)\n\n"
    )
    assert over(said) == [2.96, 1.54] and over("WORST setup 1\n") == []


@pytest.mark.parametrize("layer, violations", [((70, 20), 1), ((71, 20), 0)])
def test_a_long_wire_at_a_gate(tmp_path, layer, violations):
    """300 um of the trunks' metal at a gate of 0.03 um2; of the branches' metal nothing is reported."""
    import klayout.db as db

    tech, layout = layout_platform("sky130"), db.Layout()
    cell = layout.create_cell("gate")

    def draw(pair, *box):
        cell.shapes(layout.layer(*pair)).insert(db.DBox(*box))

    draw(tech.active, -0.1, -0.5, 0.1, 0.5)
    draw(tech.poly, -1, -0.075, 1, 0.075)
    for pair in (tech.contact, *(cut.gds for cut in tech.vias)):
        draw(pair, 0.8, -0.05, 0.9, 0.05)
    for wire in tech.metals:
        draw(wire.gds, 0.7, -0.15, 1.1, 0.15)
    draw(layer, 0.7, -0.15, 300, 0.15)
    layout.write(str(tmp_path / "die.gds"))
    given = {"die_gds.checked": tmp_path / "die.gds"}
    assert small.run(DieAntenna(PdkParameters()), given, tmp_path) == {"antenna_violations": violations}
