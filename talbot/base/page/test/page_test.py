"""Pages: texts escaped, units as people write them, what was not run, no request; the index of them."""

import os
import re
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image

from talbot.base.charts import bars, curves, svg
from talbot.base.command import main
from talbot.base.page import TABLES, Picture, Scale, Section, Tile, command, index, render, units
from talbot.base.page.check import faults

BAR = Scale(np.stack([np.arange(256, dtype=np.uint8)] * 3, -1), -1.0, 2.5, "m")
PICTURE = Picture("depth", "", "how far", Image.new("RGB", (7, 5), (200, 200, 200)), BAR)
ROWS = [("area, um2", "12 x 34"), ("proven", None)]


def page(**more):
    values = {"about": "of <a> test", "sections": [Section("A table", head=("what", "value"), rows=ROWS)]}
    return render(TABLES, "A & B", **values | more)


@pytest.mark.parametrize(
    "text, written",
    [
        ("54.1 to 56 uJ", "54.1 to 56 µJ"),
        ("9,378 um2 on 12 um, 0.3 W/m2", "9,378 µm² on 12 µm, 0.3 W/m²"),
        ("37 x 50 pixels", "37 × 50 pixels"),
        ("use us, sum uml", "use us, sum uml"),
        ("<= 3.5 us", "≤ 3.5 µs"),
        ("us", "µs"),
        ("x >= y", "x >= y"),
        (0.5, "0.5"),
        ("-0.00", "0.00"),
        ("-0.0 dB", "0.0 dB"),
        ("-0.01", "-0.01"),
    ],
)
def test_units(text, written):
    assert units(text) == written


def test_what_was_not_run_is_no_number_and_texts_are_escaped():
    text = page(tiles=[Tile("not run", "LVS", "none"), Tile("0", "open nets", "good")])
    assert '<td class="none">not run</td>' in text and "<td>area, µm²</td><td>12 × 34</td>" in text
    assert '<div class="tile none"><b>not run</b>LVS</div>' in text
    assert "of &lt;a&gt; test" in text and "<title>A &amp; B</title>" in text


def test_a_page_is_one_file_without_a_request():
    text = page(sections=[Section(pictures=[PICTURE])])
    sources = re.findall(r'(?:src|href)="([^"]*)"', text)
    assert len(sources) == 2 and all(source.startswith("data:image/png;base64,") for source in sources)
    assert "url(" not in text and "import" not in text and "<script>" in text
    assert 'data-low="-1.0" data-high="2.5" data-unit="m"' in text
    assert "<script" not in page()


@pytest.mark.parametrize(
    "html, fault",
    [
        ('<script src="https://cdn.example/a.js"></script>', "script fetches https://cdn.example/a.js"),
        ('<script src="//cdn.example/a.js"></script>', "script fetches //cdn.example/a.js"),
        ('<link rel="stylesheet" href="http://x.example/a.css">', "link fetches http://x.example/a.css"),
        ("<style>@import 'a.css';</style>", "style: @import 'a.css'"),
        ("<style>@font-face { src:url(https://x.example/f) }</style>", "style: url(https://x.example/f)"),
        ("<script>fetch('a.json')</script>", "script: fetch("),
        ('<img src="a.png">', "img a.png: no alt"),
        ('<img src="a.png" alt=" ">', "img a.png: no alt"),
        ("<svg><g></g></svg>", "svg: no role=img with aria-label"),
        ("<div><table></table></div>", "table: not in a box that scrolls"),
        ('<div class="wide"></div><table></table>', "box that scrolls: no tabindex and aria-label"),
    ],
)
def test_faults_of_a_page(html, fault):
    assert fault in faults(html)


def test_what_is_no_fault():
    html = (
        '<a href="https://example.org">a link</a><img src="data:image/png;base64,AA==" alt="a"><style>a { b:c }</style>'
    )
    html += (
        '<svg role="img" aria-label="a chart"><use xlink:href="#a"/><svg></svg></svg><img src="views/a.png" alt="a">'
    )
    html += '<p><div class="wide" tabindex="0" role="region" aria-label="a table"><table><tr><td></table></div>'
    assert faults(html) == []


def test_what_may_be_wider_than_a_screen_has_a_box_that_is_named():
    broad = svg(Figure((12, 3)))
    sections = [Section("A & B", head=("a", "b"), rows=ROWS), Section(head=("c",), rows=ROWS, charts=[broad])]
    text = page(sections=sections)
    names = re.findall(r'<div class="wide" tabindex="0" role="region" aria-label="(.*?)">', text)
    assert names == ["A &amp; B: table", "A &amp; B: chart", "A &amp; B: table 2"]
    assert faults(text) == []


def test_a_chart_is_described_in_words():
    text = svg(curves({"a": [(1, 2, "")], "b": [(1, 2, "")]}, "time, ms", "error", "Error < time"))
    assert 'role="img" aria-label="Error &lt; time; error against time, ms; a, b"' in text
    assert 'aria-label="Parts; x, y"' in svg(bars({"x": 1, "y": 2}, "uJ", "Parts"))


def test_cards_of_one_title_are_told_apart(tmp_path):
    for name in ("sim/a/report.html", "sim/b/report.html", "sim/b/other.html"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(page(picture=PICTURE.image))
    index.refresh(tmp_path)
    text = (tmp_path / "index.html").read_text()
    titles = re.findall("<div><b>(.*?)</b>", text)
    assert sorted(titles) == ["A &amp; B (a)", "A &amp; B (sim/b/other)", "A &amp; B (sim/b/report)"]
    assert re.findall('alt="(.*?)"', text) == titles


def test_the_index_lists_pages_that_have_a_card_the_newest_first(tmp_path, capsys):
    for age, name in enumerate(("sim/b/report.html", "sim/a/report.html", "verify/report.html")):
        path = tmp_path / name
        path.parent.mkdir(parents=True)
        path.write_text(page(tiles=[Tile(f"{age} uJ", "a frame")], picture=PICTURE.image))
        os.utime(path, (1e9 - age, 1e9 - age))
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "index.html").write_text("<title>of another tool</title>")
    assert main(command, ["--out", str(tmp_path)]) == 0
    assert capsys.readouterr().out == f"{tmp_path / 'index.html'}\n"
    text = (tmp_path / "index.html").read_text()
    assert re.findall('href="(.*?)"', text) == ["sim/b/report.html", "sim/a/report.html", "verify/report.html"]
    assert "2001-09-09 01:46 UTC" in text and '<b class="">1 µJ</b> a frame' in text and "A &amp; B" in text
    assert text.count("data:image/webp") == 3
    (tmp_path / "verify" / "report.html").unlink()
    index.refresh(tmp_path)
    assert "verify" not in (tmp_path / "index.html").read_text()


def test_the_index_beside_what_is_no_page(tmp_path):
    (tmp_path / "sim" / "a.html").mkdir(parents=True)
    (tmp_path / "sim" / "b.html").write_text(page()[:100])
    (tmp_path / "sim" / "c.html").write_text(page())
    for name, card in (("d", "{&#34;ti"), ("e", "[]"), ("f", "{&#34;tiles&#34;: [1], &#34;title&#34;: 2}")):
        (tmp_path / "sim" / f"{name}.html").write_text(f'<meta name="talbot" content="{card}">')
    (tmp_path / "sim" / "g.html").symlink_to("nowhere")
    (tmp_path / "index.html").write_bytes(bytes(range(256)))
    index.refresh(tmp_path)
    assert re.findall('href="(.*?)"', (tmp_path / "index.html").read_text()) == ["sim/c.html"]


def test_a_compiled_template_that_is_damaged_is_compiled_again(tmp_path, monkeypatch):
    monkeypatch.setattr("talbot.base.page.BUILD", tmp_path)
    whole, files = page(), list((tmp_path / "templates").iterdir())
    assert files
    for damage in (
        lambda data: b"",
        lambda data: data[:-9],
        lambda data: data[:60] + bytes([data[60] ^ 1]) + data[61:],
    ):
        kept = [file.read_bytes() for file in files]
        for file in files:
            file.write_bytes(damage(file.read_bytes()))
        assert page() == whole and [file.read_bytes() for file in files] == kept
    for file in files:
        file.unlink()
        file.mkdir()
    assert page() == whole


def test_a_folder_without_a_page_gets_no_index(tmp_path):
    index.refresh(tmp_path)
    assert not list(tmp_path.iterdir())
    assert main(command, ["--out", str(tmp_path / "missing")]) == 2


def test_what_is_broad_has_more_than_a_column():
    wide = replace(PICTURE, image=Image.new("RGB", (20, 5)))
    figures = [Figure((width, 3)) for width in (4.6, 12)]
    text = page(sections=[Section(pictures=[PICTURE, wide], charts=[svg(figure) for figure in figures])])
    assert text.count('<figure class="broad">') == text.count('class="broad" role="img"') == 1


def test_a_name_of_a_file_in_latin_1_is_written_as_a_mark():
    assert "sch\ufffdn.png" in page(about=os.fsdecode(b"sch\xf6n.png")).encode().decode()
