"""A small design from Verilog to GDS; faults planted in the layout are found by the rules and the comparison."""

import re

import pytest

from talbot.base.steps import Runner
from talbot.flow.layout.design import Design
from talbot.flow.layout.options import Options
from talbot.flow.layout.search import lay_out_smallest
from talbot.flow.layout.steps.drc import Drc
from talbot.flow.layout.steps.lvs import Lvs
from talbot.flow.layout.steps.parameters import PdkParameters
from talbot.flow.layout.steps.stage import Stage, StageParameters
from talbot.flow.layout.test import counter
from talbot.platforms.twins import TWIN
from talbot.signoff.netlist.netlist import Netlist

pytestmark = [pytest.mark.slow, pytest.mark.needs(*counter.NEEDS)]


@pytest.fixture(scope="module")
def runner(tmp_path_factory):
    """The Runner after a closed layout of the counter."""
    folder = tmp_path_factory.mktemp("counter")
    design = Design("counter", "Counter", "")
    made = Runner(folder / "steps", counter.files(design, counter.VERILOG, folder))
    tried = lay_out_smallest(design, Options(utilization=0.6), made, lambda design, options: [])
    assert tried[-1].rules_broken == 0, tried
    return made


def lvs(runner, gds, folder):
    """What Lvs says of another layout in place of the design's."""
    step = Lvs(PdkParameters())
    inputs = {name: runner.paths[source] for name, source in step.inputs.items()} | {"gds": gds}
    return step.run(inputs, {name: folder / file for name, file in step.outputs.items()})["lvs_match"]


def changed(runner, folder, change):
    """The layout with ``change`` (called with layout and top cell) applied: path."""
    import klayout.db as db

    layout = db.Layout()
    layout.read(str(runner.paths["fill.gds"]))
    change(layout, layout.top_cell())
    layout.write(str(folder / "changed.gds"))
    return folder / "changed.gds"


def test_the_layout_is_clean_and_matches(runner, tmp_path):
    assert runner.run(Drc(PdkParameters()))["metrics"] == {"drc_violations": 0}
    assert lvs(runner, runner.paths["fill.gds"], tmp_path)


def test_a_short_between_a_strap_and_a_signal_is_found(runner, tmp_path):
    def short(layout, top):
        import klayout.db as db

        pin = next(
            s.text.trans.disp
            for s in top.shapes(layout.layer(68, 16)).each()
            if s.is_text() and s.text.string == "step[0]" and s.text.x < 1000
        )
        strap = min(s.bbox().left for s in top.shapes(layout.layer(71, 20)).each() if s.bbox().height() > 20_000)
        patch = min(
            (
                s.bbox()
                for s in top.shapes(layout.layer(68, 20)).each()
                if s.bbox().left == strap and s.bbox().height() > 600
            ),
            key=lambda box: abs(box.center().y - pin.y),
        )
        top.shapes(layout.layer(68, 20)).insert(db.Box(pin.x, pin.y - 100, strap + 400, pin.y + 100))
        top.shapes(layout.layer(68, 20)).insert(
            db.Box(strap + 200, min(pin.y, patch.bottom), strap + 400, max(pin.y, patch.top))
        )

    assert not lvs(runner, changed(runner, tmp_path, short), tmp_path)


def test_a_cut_net_is_found(runner, tmp_path):
    def cut(layout, top):
        segments = [s for s in top.shapes(layout.layer(69, 20)).each() if s.is_box() or s.is_path() or s.is_polygon()]
        max(segments, key=lambda shape: shape.bbox().height() * (shape.bbox().width() < 500)).delete()

    assert not lvs(runner, changed(runner, tmp_path, cut), tmp_path)


def test_wires_too_near_are_found(runner, tmp_path):
    def near(layout, top):
        import klayout.db as db

        box = next(s.bbox() for s in top.shapes(layout.layer(69, 20)).each() if s.bbox().height() > 3000)
        top.shapes(layout.layer(69, 20)).insert(box.moved(box.width() + 100, 0) & db.Box(top.bbox()))

    gds, step = changed(runner, tmp_path, near), Drc(PdkParameters())
    inputs = {"gds": gds, "deck": runner.paths["library.drc"]}
    assert step.run(inputs, {n: tmp_path / f for n, f in step.outputs.items()})["drc_violations"] > 0


def test_a_hole_that_is_too_small_is_found(runner, tmp_path):
    """A rule that PDKMaster's deck does not have."""

    def ring(layout, top):
        import klayout.db as db

        right = top.bbox().right + 5000
        metal = db.Region(db.Box(right, 0, right + 2000, 2000)) - db.Region(
            db.Box(right + 800, 800, right + 1100, 1200)
        )
        top.shapes(layout.layer(69, 20)).insert(metal)

    gds, step = changed(runner, tmp_path, ring), Drc(PdkParameters())
    inputs = {"gds": gds, "deck": runner.paths["library.drc"]}
    assert step.run(inputs, {n: tmp_path / f for n, f in step.outputs.items()})["drc_violations"] == 1


def test_the_netlist_has_the_twins_that_thresholds_names(runner):
    netlist = Netlist.read(runner.paths["stream_out.netlist"])
    twins = {instance.name for instance in netlist.instances if instance.cell.endswith(TWIN)}
    assert len(twins) > 10 and twins == set(runner.paths["thresholds.raised"].read_text().split())


def test_the_driver_of_a_net_with_a_large_load_stays_plain(runner, tmp_path):
    netlist = Netlist.read(runner.paths["stream_out.netlist"])
    driver = next(i for i in netlist.instances if i.cell == f"inv_x1{TWIN}")
    wires = runner.paths["routed_extraction.max"].read_text()
    name = driver.pins["nq"]
    loaded, times = re.subn(rf"(?m)^(\*D_NET {name} .*\n(?:.*\n)*?\*CAP\n1 \S+) \S+", r"\1 200", wires)
    assert times == 1
    (tmp_path / "wires.spef").write_text(loaded)
    step = Stage(StageParameters(top="Counter", corners=Options().corners, stage="thresholds", clock="clk"))
    inputs = {name: runner.paths[source] for name, source in step.inputs.items()} | {"wires": tmp_path / "wires.spef"}
    metrics = step.run(inputs, {name: tmp_path / file for name, file in step.outputs.items()})
    assert metrics["stopped"] is None and metrics["routed_beyond"]
    before, after = (
        set(path.read_text().split()) for path in (runner.paths["thresholds.raised"], tmp_path / "raised.txt")
    )
    assert driver.name in before - after
