"""A layout written at another time is the same file."""

import time

import klayout.db as db
import pytest

from talbot.base.gds import write_gds

pytestmark = pytest.mark.needs("layout")


def test_the_same_layout_is_the_same_file(tmp_path):
    layout = db.Layout()
    top = layout.create_cell("top")
    layout.create_cell("other")
    top.shapes(layout.layer(1, 0)).insert(db.Box(0, 0, 10, 20))
    write_gds(layout, tmp_path / "a.gds")
    time.sleep(1.1)  # GDS's time stamps are seconds
    write_gds(layout, tmp_path / "b.gds")
    assert (tmp_path / "a.gds").read_bytes() == (tmp_path / "b.gds").read_bytes()
    write_gds(layout, tmp_path / "top.gds", top)
    read = db.Layout()
    read.read(str(tmp_path / "top.gds"))
    assert [cell.name for cell in read.each_cell()] == ["top"]
