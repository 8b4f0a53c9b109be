"""The committed documents are those that the sources give."""

import re
from xml.etree import ElementTree

from talbot.base.page.check import faults
from talbot.base.paths import ROOT
from talbot.commands import main
from talbot.models.parameters.registers import register_map
from talbot.rtl.asp_chip.pins import pins
from talbot.rtl.host.document import command
from talbot.rtl.host.document.c_header import c_header
from talbot.rtl.host.document.command import DOCUMENT, HEADER
from talbot.rtl.host.document.exports import IPXACT, PAGE, export
from talbot.rtl.host.document.pins import MEANING
from talbot.rtl.host.document.tables import TABLES

WRITTEN = "registers.md", DOCUMENT


def test_the_committed_documents_are_current(tmp_path, capsys):
    """If this fails: make document."""
    (tmp_path / DOCUMENT).write_text((ROOT / "docs" / DOCUMENT).read_text())
    words = ["--out", tmp_path, "--header", tmp_path / HEADER.name, "--exports", tmp_path / "exports"]
    assert main(["document", *map(str, words)]) == 0
    printed = capsys.readouterr().out
    assert f"look at {tmp_path / 'exports' / PAGE}" in printed and all(name in printed for name in WRITTEN)
    for name in WRITTEN:
        assert (tmp_path / name).read_text() == (ROOT / "docs" / name).read_text(), name
    assert (tmp_path / HEADER.name).read_text() == HEADER.read_text()


def test_the_documents_of_another_sensor_have_its_sizes(tmp_path, monkeypatch):
    (tmp_path / "odd.toml").write_text(
        "array.rows = 40\narray.cols = 60\ntile.rows = 2\ntile.cols = 3\nchip.lanes = 4\n"
    )
    monkeypatch.setattr(command, "RESULTS", tmp_path)
    assert main(["document", f"--sensor={tmp_path / 'odd.toml'}"]) == 0
    folder = tmp_path / "document" / "odd"
    header, page = (folder / HEADER.name).read_text(), (folder / "host.md").read_text()
    for name, value in (
        ("ROWS", "0x28u"),
        ("COLS", "0x3cu"),
        ("LANES", "0x4u"),
        ("TILE_ROWS", "0x2u"),
        ("ROW1", "0x13u"),
    ):
        assert f"#define ASP_{name}_DEFAULT {value}\n" in header
    assert "has 40 x 60 pixels and 4 lanes" in page and re.search(r"(?m)^ *39 +19 +2 +0 ", page)
    assert "| rows | ro, 0x28 |" in (folder / "registers.md").read_text()
    assert "'h28" in (folder / "registers" / IPXACT).read_text()
    for link in re.findall(r"\]\(([^)#:]+)", page):
        assert (folder / link).exists(), link
    assert HEADER.read_text() == c_header(register_map())


def test_a_wrong_place_is_refused_before_anything_is_written(tmp_path, capsys):
    for words, said in ((["--header", tmp_path], "must be a file"), ([], "must be a folder with host.md")):
        assert main(["document", "--out", str(tmp_path), "--exports", str(tmp_path / "exports"), *map(str, words)]) == 2
        err = capsys.readouterr().err
        assert said in err and err.count("\n") == 1 and not list(tmp_path.iterdir())


def test_the_map_for_other_tools_has_every_field(tmp_path):
    export(tmp_path)
    space = {"i": "http://www.accellera.org/XMLSchema/IPXACT/1685-2014"}
    component = ElementTree.parse(tmp_path / IPXACT)
    for register in component.iterfind(".//i:register", space):
        name, offset = register.findtext("i:name", "", space), register.findtext("i:addressOffset", "", space)
        for node in register.iterfind("i:field", space):
            key = f"{name}[0].trim" if name == "trim" else node.findtext("i:name", "", space)
            field, lsb = register_map()[key], int(node.findtext("i:bitOffset", "", space))
            assert (field.address, field.lsb) == (int(offset.replace("'h", "0x"), 16), lsb)
            assert field.width == int(node.findtext("i:bitWidth", "", space))
    names = {node.text for node in component.iterfind(".//i:field/i:name", space)}
    page = (tmp_path / PAGE).read_text()
    assert not faults(page)
    for field in register_map().fields:
        shown = field.name if not field.name.startswith("trim") else "trim[0..23]"
        assert field.name in names and f"{shown}</td>" in page and str(ROOT) not in page


def test_every_field_is_documented():
    text = (ROOT / "docs" / "registers.md").read_text()
    rows = set(re.findall(r"\| (?:\w+\.)?(\w+)(?:\[0\.\.23\])? \| [rw]", text))
    assert rows == {f.name for f in register_map().fields}
    assert all(f.description in text for f in register_map().fields)
    assert "| 0x20 + 2 i [9:0] | trim[0..23] |" in text and "| 0x02[0] | control.start |" in text


def test_every_pin_is_documented():
    named = set(re.findall(r"`(\w+)`", (ROOT / "docs" / "chip.md").read_text())) | set(MEANING)
    assert not {name for ports in pins(1) for name in ports} - named


def test_the_host_document_has_a_place_for_every_table():
    assert set(re.findall(r"<!-- (?!end)(.*?) -->", (ROOT / "docs" / DOCUMENT).read_text())) == set(TABLES)
