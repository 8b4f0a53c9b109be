"""Only platforms/<pdk> knows a process; every process has what the embedded backend asks for."""

import importlib.util
import re

import pytest

from base.paths import ROOT
from models.parameters import ParameterError
from platforms.coriolis import coriolis_platform
from platforms.extraction import extraction_platform
from platforms.load import PROCESSES
from platforms.patience import patience

# "sky130" in quotes: a default
OF_A_PROCESS = re.compile(r'sky130(?!")|ihp|sg13|[np]fet|\bmet\d|\(\d+, (?:20|16|5|44)\)')


def test_no_step_knows_a_process():
    files = [
        path
        for folder in ("flow/layout", "base/steps", "flow/handoff")
        for path in (ROOT / folder).rglob("*.py")
        if "test" not in path.parts
    ]
    assert len(files) > 40
    found = {path.name: OF_A_PROCESS.findall(path.read_text()) for path in files}
    assert {name: words for name, words in found.items() if words} == {}


@pytest.mark.parametrize("pdk", PROCESSES)
def test_figures_fit_each_other(pdk):
    known = coriolis_platform(pdk)
    assert known.name == pdk
    cell_tech = extraction_platform(pdk)
    assert {via.above for via in cell_tech.vias} <= {layer.lef for layer in cell_tech.conductors}
    for lower, via, upper in zip(known.metals, known.vias, known.metals[1:], strict=False):
        assert (via.below, via.above) == ((lower.lef,), upper.lef)
    assert abs(known.row_um / known.site_um - round(known.row_um / known.site_um)) < 1e-9  # else wells overlap
    assert len(known.vias) == len(known.metals) - 1
    for size in (known.row_um, known.site_um, known.strap_um, *known.pin_pitch_um.values()):
        assert abs(size / known.grid_um - round(size / known.grid_um)) < 1e-6
    assert all(cut.size_um + 2 * cut.enclosure_um < known.strap_um for cut in known.vias)
    assert known.fill.density < known.fill.density_most and known.fill.clearance_um >= known.fill.space_um
    assert list(known.fill.sides_um) == sorted(known.fill.sides_um, reverse=True)


@pytest.mark.slow  # importing a process's package draws its cells
@pytest.mark.filterwarnings("ignore:gate oxide:DeprecationWarning")  # c4m-pdk-ihpsg13g2's own
@pytest.mark.parametrize("pdk", PROCESSES)
def test_what_the_wheel_says_agrees(pdk):
    known = coriolis_platform(pdk)
    if not importlib.util.find_spec("pdkmaster"):
        pytest.skip("pdkmaster: not installed; make layout installs it")
    with patience():
        tech = importlib.import_module(f"{known.package}.pdkmaster")
    for wire in (*known.metals, *known.vias):
        assert tech.gds_layers[wire.name] == wire.gds
    for wire in known.metals[1:]:
        rules, fill = tech.tech.primitives[wire.name], known.fill
        assert min(fill.sides_um) >= rules.min_width and min(fill.sides_um) ** 2 >= (rules.min_area or 0)
        assert fill.space_um >= rules.min_space
    for cut in known.vias:
        rules = tech.tech.primitives[cut.name]
        assert cut.size_um == pytest.approx(rules.width) and cut.space_um >= rules.min_space


def test_a_process_that_is_none():
    with pytest.raises(ParameterError, match="must be one of sky130, ihp-sg13g2"):
        coriolis_platform("gf180mcu")
