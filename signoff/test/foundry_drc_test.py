"""Checks of an installed PDK: a small one with a deck and a technology of one metal, read by the real tools."""

import shutil

import klayout.db as db
import pytest

from talbot.base.steps import StepError
from talbot.models.parameters import ParameterError
from talbot.platforms.foundry import foundry_checks, installed
from talbot.signoff.foundry_drc import FoundryDrc, FoundryDrcParameters, MagicDrc

pytestmark = pytest.mark.needs("layout")

DECK = """
source($input, $topcell)
report("one metal", $report)
metal = input(68, 20)
metal.space(0.14.um).output("m1.2", "space") if $beol == "true"
"""
TECHNOLOGY = """tech
  format 29
  small
end
version
  version 1
  description "one metal"
end
planes
  metal1,m1
end
types
  metal1 metal1,m1
end
contact
end
styles
  styletype mos
  metal1 1
end
compose
end
connect
  metal1 metal1
end
cifoutput
style gdsii
  scalefactor 10 nanometers
  layer MET1 metal1
    calma 68 20
end
cifinput
style gdsii
  scalefactor 10 nanometers
  layer metal1 MET1
  calma MET1 68 20
end
drc
style drc(full)
  spacing metal1 metal1 14 touching_ok "space below 0.14 um"
end
extract
end
"""


@pytest.fixture
def root(tmp_path):
    checks = foundry_checks("sky130")
    for path, text in (
        (checks.klayout, DECK),
        (f"{checks.magic}/small.tech", TECHNOLOGY),
        (f"{checks.magic}/{checks.rc}", f"tech load $::env(PDK_ROOT)/{checks.magic}/small.tech\n"),
    ):
        (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / path).write_text(text)
    return tmp_path


def checked(step, root, gap_nm):
    """Metrics of ``step`` for two segments so far from one another."""
    layout = db.Layout()
    layout.dbu = 0.001
    metal = layout.create_cell("top").shapes(layout.layer(68, 20))
    for bottom in (0, 140 + gap_nm):
        metal.insert(db.Box(0, bottom, 1000, bottom + 140))
    layout.write(str(root / "wires.gds"))
    inputs = {"gds": root / "wires.gds"} | installed("sky130", {"PDK_ROOT": str(root)})
    inputs["deck"] = inputs["klayout"]
    return step.run(inputs, {name: root / file for name, file in step.outputs.items()})


@pytest.mark.parametrize("gap_nm, broken", [(150, 0), (100, 1)])
@pytest.mark.parametrize(
    "tool, kind",
    [
        pytest.param("klayout", FoundryDrc, marks=pytest.mark.needs("klayout")),
        pytest.param("magic", MagicDrc, marks=pytest.mark.needs("magic")),
    ],
)
def test_a_space_that_is_too_small(tool, kind, gap_nm, broken, root):
    found = checked(kind(FoundryDrcParameters("sky130", "top")), root, gap_nm)
    assert list(found.values()) == [broken]


@pytest.mark.needs("klayout")
def test_a_deck_that_fails_is_reported(root):
    (root / foundry_checks("sky130").klayout).write_text("no_such_word(1)\n")
    with pytest.raises(StepError, match="sky130A_mr.drc failed: .*no_such_word"):
        checked(FoundryDrc(FoundryDrcParameters("sky130", "top")), root, 150)


@pytest.mark.needs("magic")
def test_a_technology_that_fails_is_reported(root):
    (root / foundry_checks("sky130").magic / "sky130A.magicrc").write_text("no_such_word\n")
    with pytest.raises(StepError, match="magic_drc: Magic failed"):
        checked(MagicDrc(FoundryDrcParameters("sky130", "top")), root, 150)


def test_installed_decks(root):
    assert installed("sky130", {}) == {} and installed("ihp-sg13g2", {"PDK_ROOT": str(root)}) == {}
    assert set(installed("sky130", {"PDK_ROOT": str(root)})) == {"klayout", "magic"}
    shutil.rmtree(root / "sky130A")
    with pytest.raises(ParameterError, match="PDK_ROOT = .*: must hold sky130A/libs.tech/klayout"):
        installed("sky130", {"PDK_ROOT": str(root)})
