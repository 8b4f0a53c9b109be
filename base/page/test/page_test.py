"""Pages: texts escaped, units as people write them, what was not run, no request; the index of them."""

import os
import re

import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image

from talbot.base.charts import svg
from talbot.base.command import main
from talbot.base.page import TABLES, Picture, Scale, Section, Tile, command, index, render, units

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
    (tmp_path / "index.html").write_bytes(bytes(range(256)))
    index.refresh(tmp_path)
    assert re.findall('href="(.*?)"', (tmp_path / "index.html").read_text()) == ["sim/c.html"]


def test_a_folder_without_a_page_gets_no_index(tmp_path):
    index.refresh(tmp_path)
    assert not list(tmp_path.iterdir())
    assert main(command, ["--out", str(tmp_path / "missing")]) == 2


def test_what_is_broad_has_more_than_a_column():
    wide = PICTURE._replace(image=Image.new("RGB", (20, 5)))
    figures = [Figure((width, 3)) for width in (4.6, 12)]
    text = page(sections=[Section(pictures=[PICTURE, wide], charts=[svg(figure) for figure in figures])])
    assert text.count('<figure class="broad">') == text.count('class="broad" viewBox') == 1
