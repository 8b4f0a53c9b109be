"""The steps of a layout: the README lists each with its file and its test; installed decks are run."""

from pathlib import Path

from flow.layout.chain import signoff_steps
from flow.layout.design import design
from flow.layout.options import Options


def test_installed_decks_are_run():
    options = Options(decks=(("klayout", Path("deck")), ("magic", Path("deck"))))
    assert {"foundry_drc", "magic_drc"} <= {step.name for step in signoff_steps(design("amp_ctrl"), options)}
