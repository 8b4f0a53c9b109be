"""Only platforms/<pdk> describes a process; every process has what the layout flow requires."""

import asyncio
import re
import sys

import pytest

from talbot.base.paths import ROOT
from talbot.models.parameters import ParameterError
from talbot.platforms.extraction import extraction_platform
from talbot.platforms.layout import layout_platform
from talbot.platforms.patience import imported
from talbot.platforms.processes import PROCESSES

# "sky130" in quotes: a default
OF_A_PROCESS = re.compile(r'sky130(?!")|ihp|sg13|[np]fet|\bmet\d|\(\d+, (?:20|16|5|44)\)')


def test_no_step_names_a_process():
    files = [
        path
        for folder in ("flow/layout", "signoff", "talbot/base/steps", "flow/handoff")
        for path in (ROOT / folder).rglob("*.py")
        if "test" not in path.parts
    ]
    assert len(files) > 40
    found = {path.name: OF_A_PROCESS.findall(path.read_text()) for path in files}
    assert {name: words for name, words in found.items() if words} == {}


@pytest.mark.parametrize("pdk", PROCESSES)
def test_figures_fit_each_other(pdk):
    tech = layout_platform(pdk)
    assert tech.name == pdk
    cell_tech = extraction_platform(pdk)
    assert {via.above for via in cell_tech.vias} <= {layer.lef for layer in cell_tech.conductors}
    for lower, via, upper in zip(tech.metals, tech.vias, tech.metals[1:], strict=False):
        assert (via.below, via.above) == ((lower.lef,), upper.lef)
    assert abs(tech.row_um / tech.site_um - round(tech.row_um / tech.site_um)) < 1e-9  # else wells overlap
    assert len(tech.vias) == len(tech.metals) - 1
    for size in (tech.row_um, tech.site_um, tech.strap_um, *tech.pin_pitch_um.values()):
        assert abs(size / tech.grid_um - round(size / tech.grid_um)) < 1e-6
    assert all(via.size_um + 2 * via.enclosure_um < tech.strap_um for via in tech.vias)
    assert tech.fill.density_least < tech.fill.density < tech.fill.density_most
    assert set(tech.fill.clearances_um) >= {metal.name for metal in tech.metals[1:]}


@pytest.mark.needs("layout")
@pytest.mark.slow  # importing a process's package draws its cells
@pytest.mark.filterwarnings("ignore:gate oxide:DeprecationWarning")  # c4m-pdk-ihpsg13g2's own
@pytest.mark.parametrize("pdk", PROCESSES)
def test_the_wheel_agrees(pdk):
    tech = layout_platform(pdk)
    wheel = imported(f"{tech.package}.pdkmaster")
    for part in (*tech.metals, *tech.vias):
        assert wheel.gds_layers[part.name] == part.gds
    for metal in tech.metals[1:]:
        rules, fill = wheel.tech.primitives[metal.name], tech.fill
        assert fill.width_um >= rules.min_width and fill.area_um2 >= (rules.min_area or 0)
        assert min(fill.clearances_um[metal.name]) >= rules.min_space
    for via in tech.vias:
        rules = wheel.tech.primitives[via.name]
        assert via.size_um == pytest.approx(rules.width) and via.space_um >= rules.min_space


def test_a_busy_machine_has_a_minute_for_a_cell(tmp_path, monkeypatch):
    """A process that draws while it is imported, and takes longer than it allows itself."""
    (tmp_path / "slow_process.py").write_text(
        "import asyncio\n"
        "async def draw():\n"
        "    return await asyncio.wait([asyncio.create_task(asyncio.sleep(0.05))], timeout=0.01)\n"
        "loop = asyncio.get_event_loop()\n"
        "done, running = loop.run_until_complete(draw())\n"
    )
    monkeypatch.syspath_prepend(tmp_path)
    wait = asyncio.wait
    slow = imported("slow_process")
    assert not slow.running and slow.loop.is_closed()
    assert asyncio.wait is wait


def test_pads_are_drawn_where_they_are_asked_for_alone(tmp_path, monkeypatch):
    """A package that imports its pads, and a module that does not want them."""
    folder = tmp_path / "made" / "up" / "process"
    folder.mkdir(parents=True)
    (folder / "__init__.py").write_text("from .io import __all__\n")
    (folder / "io.py").write_text("__all__ = ['pads']\npads = 3\n")
    (folder / "rules.py").write_text("space = 0.17\n")
    monkeypatch.syspath_prepend(tmp_path)
    assert imported("made.up.process.rules").space == 0.17
    assert "made.up.process.io" not in sys.modules
    assert imported("made.up.process.io").pads == 3
    assert imported("made.up.process").__all__ == []


def test_an_unknown_process():
    with pytest.raises(ParameterError, match="must be one of sky130, ihp-sg13g2"):
        layout_platform("gf180mcu")
