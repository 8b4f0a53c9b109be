"""The committed documents are those that the sources give."""

import re

from base.paths import ROOT
from flow.host.document.command import HEADER
from flow.host.document.tables import TABLES
from models.parameters.registers import register_map
from talbot.__main__ import main

TABLED = "host.md", "chip.md", "stream.md"
WRITTEN = "registers.md", "registers.html", *TABLED


def test_the_committed_documents_are_current(tmp_path):
    """If this fails: make document."""
    for name in TABLED:
        (tmp_path / name).write_text((ROOT / "docs" / name).read_text())
    assert main(["document", "--out", str(tmp_path), "--header", str(tmp_path / HEADER.name)]) == 0
    for name in WRITTEN:
        assert (tmp_path / name).read_text() == (ROOT / "docs" / name).read_text(), name
    assert (tmp_path / HEADER.name).read_text() == HEADER.read_text()


def test_every_field_is_documented():
    text = (ROOT / "docs" / "registers.md").read_text()
    assert all(f"| {f.name} |" in text and f.description in text for f in register_map().fields)
    assert "| 0x20 + 2 i | trim[0..23] |" in text


def test_the_host_document_explains_every_field():
    words = set(re.findall(r"\w+", (ROOT / "docs" / "host.md").read_text()))
    assert not {f.name for f in register_map().fields} - words


def test_the_host_document_has_a_place_for_every_table():
    assert set(re.findall(r"<!-- (?!end)(.*?) -->", (ROOT / "docs" / "host.md").read_text())) == set(TABLES)
