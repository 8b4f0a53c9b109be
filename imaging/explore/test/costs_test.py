"""What a frame costs, beside the Verilog's frame, and the area beside the pages that it is from."""

import re
from dataclasses import replace

import pytest

from talbot.base.paths import ROOT
from talbot.imaging.explore import costs
from talbot.imaging.frame.figures import energy_of
from talbot.imaging.frame.job import simulate_frame
from talbot.imaging.frame.request import request
from talbot.models.parameters import STANDARD, ParameterError
from talbot.models.plan.exposure import frame_cycles

SIZE = {"rows": 13, "cols": 50, "lanes": 4}  # of other tests, too: one simulator


@pytest.mark.parametrize(
    "mode, phase", [("edge", False), ("image", False), ("raw", False), ("tof", False), ("tof", True)]
)
def test_costs_are_those_of_the_verilog(mode, phase):
    scene = {"scale": 1.0, "focus": 3.0, "focal_length": 25e-3}
    camera = replace(STANDARD.optics.camera, **scene) if mode == "tof" else None
    asked = request(**SIZE, scene="tilted" if mode == "tof" else "coins", mode=mode, phase=phase, camera=camera)
    result = simulate_frame(asked)
    real, energy = result.chip.status["cycles"], energy_of(result)["total"]
    assert frame_cycles(asked.frame, asked.sensor) == pytest.approx(real, rel=0.05)
    measured = costs.measured([asked], [result])
    assert measured["energy_uj"] == pytest.approx(energy, rel=0.05) and measured["bytes"] == len(result.stream)
    least = costs.least([asked])
    assert least["energy_uj"] <= measured["energy_uj"] and least["bytes"] < measured["bytes"]


def test_gates_are_those_of_the_results():
    pages = {name: (ROOT / f"docs/results/{name}.md").read_text(encoding="utf-8") for name in ("blocks", "layout")}
    gates = {
        block: int(count.replace(",", ""))
        for block, count in re.findall(r"\[(\w+)\].* ([\d,]+) \|$", pages["blocks"], re.M)
    }
    of_divider = {"cordic": gates["Cordic"]} | {
        name.removeprefix("QuadDivider").lower(): count for name, count in gates.items() if name.startswith("Quad")
    }
    assert of_divider == costs.DIVIDER_GATES and gates["AspChip"] == costs.CHIP_GATES
    assert gates["AdcBank"] / costs.LANES == costs.LANE_GATES
    assert f"AspChip has {costs.PHASE_GATES:,} gates" in pages["blocks"]
    assert f"| asp_chip | compact | {costs.CHIP_MM2:.4f} |" in pages["layout"]


def test_area_counts_lanes_and_divider():
    area = costs.area_mm2(STANDARD)
    more = replace(STANDARD, chip=replace(STANDARD.chip, lanes=16, divider="pipelined"))
    assert 17 < area < 18 and 0.57 < costs.area_mm2(more) - area < 0.65
    less = replace(STANDARD, chip=replace(STANDARD.chip, divider="none"))
    assert area - costs.area_mm2(less) == pytest.approx(0.2231 * 3063 / 25892)
    with pytest.raises(ParameterError, match="chip.f_clk = 2e"):
        costs.check_settling(replace(STANDARD, chip=replace(STANDARD.chip, f_clk=20e6)))
