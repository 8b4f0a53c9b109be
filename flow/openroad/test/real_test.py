"""The flow on a real `openroad`, where it is on PATH and PDK_ROOT names a PDK: the divider keeps every limit."""

import json

import pytest

from talbot.base.command import main
from talbot.flow.openroad import command

pytestmark = [pytest.mark.needs("openroad", "PDK_ROOT"), pytest.mark.slow]


def test_the_divider_closes(tmp_path, capsys):
    assert main(command, ["quad_divider", "--out", str(tmp_path)]) == 0, capsys.readouterr().err
    summary = json.loads((tmp_path / "quad_divider-openroad" / "summary.json").read_text())
    assert summary["equivalence"] == "proven" and summary["lvs_match"] is True
    assert summary["area_um2"] < 13_000 and summary["gate_tests"]["failed"] == 0
    by_source = summary["wire_pf_by_source"]
    assert by_source["placement"] == pytest.approx(by_source["nom"], rel=0.2)
    # Global routes end in the middle of a GCell, and every pin has a wire to it: repair errs on the safe side
    assert by_source["nom"] < by_source["global routes"] < 2 * by_source["nom"]
