"""`talbot layout tt_pixels` refuses what is for designs of cells, before it draws anything."""

import pytest

from talbot.base.command import main
from talbot.flow.layout import command


@pytest.mark.parametrize("option", ["--utilization=0.5", "--top=chip", "--period-ns=20", "--analog=folder"])
def test_options_of_other_designs_are_refused(option, tmp_path, capsys):
    out = tmp_path / "out"
    assert main(command, ["tt_pixels", option, "--out", str(out)]) == 2
    name = option.partition("=")[0].strip("-").replace("-", "_")
    assert f"{name} = " in capsys.readouterr().err
    assert not out.exists()
