"""The pin map: leads by hand, wires that do not cross, pads without a clamp."""

from dataclasses import replace

import pytest
from matplotlib import rc_context

from talbot.base.steps import StepError
from talbot.flow.layout.report.metrics import broken
from talbot.flow.layout.sensor import package
from talbot.flow.layout.sensor.metrics import RULES
from talbot.platforms.pads import pad_process

DIE = [4_000_000, 4_000_000]


def plan(**sides):
    """A plan with pads of these names on each side, evenly."""
    ring = []
    for side, names in sides.items():
        step = 3_600_000 // max(len(names), 1)
        for k, name in enumerate(names):
            at = 200_000 + k * step
            flat = side in ("south", "north")
            low = 15_000 if side in ("south", "west") else 3_797_000
            box = (at, low, at + 90_000, low + 188_000) if flat else (low, at, low + 188_000, at + 90_000)
            ring.append(
                {"name": f"pad_{name}", "side": side, "cell": "IOPadIn", "at": at, "nets": {"pad": name}, "box": box}
            )
    ring.append({"name": "south_5", "side": "south", "cell": "Filler200", "at": 0, "nets": {}, "box": [0, 0, 0, 0]})
    return {"die": DIE, "ring": ring}


def test_leads_are_counterclockwise_from_the_north_of_the_west():
    chosen, leads = package.packaged(plan(west=["low", "high"], south=["a", "b"], east=["c", "d"], north=["f", "e"]))
    assert chosen == package.Package(48, 0.5) and chosen.body_mm == 7.5
    assert [lead.signal for lead in leads] == ["high", "low", "a", "b", "c", "d", "e", "f"]
    assert [lead.number for lead in leads] == [4, 10, 16, 22, 28, 34, 40, 46]
    assert leads[0].lead_mm == (-(7.5 / 2 - 0.6), 2.5 * 0.5) and package.crossings(leads) == []


def test_the_fullest_side_decides_the_package():
    names = [f"n{k}" for k in range(17)]
    assert package.packaged(plan(south=names, west=["a"]))[0].leads == 80
    with pytest.raises(StepError, match="package: 37 pads on a side, 36 leads at most"):
        package.packaged(plan(south=[f"n{k}" for k in range(37)]))


def test_a_small_die_takes_a_finer_pitch_where_its_wires_would_be_too_long():
    """Lead 1 of 80 is 4.75 mm north of the middle at 0.5 mm, 3.8 mm at 0.4 mm."""
    few, many = plan(south=["a"]), plan(south=[f"n{k}" for k in range(20)], west=[f"w{k}" for k in range(20)])
    assert package.packaged(few)[0].pitch_mm == package.packaged(many)[0].pitch_mm == 0.5
    for place in many["ring"]:
        place["box"] = [um // 2 for um in place["box"]]
    chosen, leads = package.packaged(many | {"die": [2_000_000, 2_000_000]})
    assert chosen == package.Package(80, 0.4) and chosen.body_mm == 9.6
    assert max(lead.wire_mm for lead in leads) <= package.WIRE_MM and not package.crossings(leads)


def test_a_wire_that_is_too_long_breaks_a_limit():
    """As of the die with 34 pads in the south: a package of 144 leads, wires of 9.8 mm."""
    assert RULES["bond_wire_mm"]["most"] == package.WIRE_MM
    assert broken({"bond_wire_mm": 9.81}, {"bond_wire_mm": RULES["bond_wire_mm"]})
    assert not broken({"bond_wire_mm": 4.4}, {"bond_wire_mm": RULES["bond_wire_mm"]})


def test_two_leads_swapped_cross():
    _, leads = package.packaged(plan(south=["a", "b", "c"]))
    one, other, third = leads
    swapped = [
        package.Lead(one.number, "a", one.cell, one.pad_um, other.lead_mm, one.die_mm),
        package.Lead(other.number, "b", other.cell, other.pad_um, one.lead_mm, other.die_mm),
        third,
    ]
    assert package.crossings(swapped) == [("a", "b")]


SPICE = """.subckt Clamp_N n g
Mclamp_g0 n g n n sky130_fd_pr__nfet_g5v0d10v5__model l=6e-07 w=1.69e-05
Mclamp_g1 n g n n sky130_fd_pr__nfet_g5v0d10v5__model l=6e-07 w=1.69e-05
.ends Clamp_N
.subckt Good n g
Xclamp n g Clamp_N
.ends Good
.subckt Core n g
Mclamp_g0_r0 n g n n sky130_fd_pr__nfet_01v8__model l=1.8e-07 w=1.9e-05
Mnmos0 n g n n sky130_fd_pr__nfet_01v8__model l=1.8e-07 w=2.4e-06
.ends Core
.subckt Bare n g
R1 n g 2.4e+02 res l=1 w=1
.ends Bare
"""


def test_a_pad_without_a_clamp_is_named():
    clamps = {"Good": "n 34 um", "Core": "n 19 um of thin oxide"}
    assert package.protection(SPICE, ["Good", "Core"]) == clamps
    with pytest.raises(StepError, match="pads: Bare has no clamp"):
        package.protection(SPICE, ["Good", "Bare"])


def test_numbers_of_supply_pads_are_not_of_the_lead():
    assert package.signal("pad_vdd_2") == "vdd" and package.signal("pad_link_data[3]") == "link_data[3]"


def test_an_analog_signal_has_no_level_of_its_pad():
    """What is to be 1.8 V or less at an analog pad is not said to be the pads' 3.3 V."""
    process = pad_process("sky130")
    _, leads = package.packaged(plan(south=["clk", "vref"]))
    clk, vref = leads[0], replace(leads[1], cell=process.signals["analog"])
    assert package.volts(clk, process, 3.3, 5.0) == 3.3 and package.volts(vref, process, 3.3, 5.0) is None


def test_a_users_settings_of_matplotlib_change_no_picture(tmp_path):
    lead = package.Lead(1, "clk", "pad", (100.0, 200.0), (-3.0, 2.0), (4.0, 4.0))
    package.draw([tmp_path / "plain.png"], package.Package(24), [lead])
    with rc_context({"figure.facecolor": "red", "font.size": 30, "savefig.bbox": "tight"}):
        package.draw([tmp_path / "styled.png"], package.Package(24), [lead])
    assert (tmp_path / "plain.png").read_bytes() == (tmp_path / "styled.png").read_bytes()
