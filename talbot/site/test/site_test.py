"""The documents: examples run, make lines are understood, links lead somewhere, diagrams are those of the code."""

import os
import re
import shlex
import shutil
import subprocess
import xml.etree.ElementTree as xml

import pytest
from PIL import Image

from talbot.base.command import Parser, add_command
from talbot.base.command import main as run_command
from talbot.base.page import index
from talbot.base.paths import ROOT
from talbot.commands import command
from talbot.make import arguments
from talbot.models.parameters import SensorParameters
from talbot.rtl.amp_ctrl.ports import SLOT
from talbot.rtl.tops import build_top
from talbot.site import api, architecture, collect, diagrams, gallery
from talbot.site import command as site

PYTHON = re.compile(r"(?ms)^```python\n(.*?)^```")
MAKE = re.compile(r"(?m)^ {4}make ([a-z-]+)(.*?)(?:#.*)?$")
TUTORIAL = sorted((ROOT / "docs" / "tutorial").glob("*.md"))
OF_MAKE = "PDK_ROOT", "SCHEDULER", "PYTHON"


@pytest.mark.parametrize("path", TUTORIAL, ids=lambda path: path.stem)
def test_examples_run(path, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    blocks = PYTHON.findall(path.read_text())
    assert blocks
    exec(compile("\n".join(blocks), path.name, "exec"), {})


def make_lines():
    for path in [ROOT / "README.md", *TUTORIAL]:
        for target, words in MAKE.findall(path.read_text()):
            yield pytest.param(target, words, id=f"{path.stem}: {target}{words.rstrip()}")


@pytest.mark.parametrize("target, words", list(make_lines()))
def test_make_knows_every_target_and_variable(target, words):
    variables = [word.strip("[]") for word in shlex.split(words) if "=" in word]
    given = [word for word in variables if word.partition("=")[0] not in OF_MAKE]
    ready = [f"-o.venv/.{name}ready" for name in ("", "video-", "tests-", "layout-", "explore-")]
    own = {name: value for name, value in os.environ.items() if not name.startswith(("MAKE", "MFLAGS", "TALBOT"))}
    line = ["make", "-n", *ready, "-ohave-tools", target, *given]
    recipe = subprocess.run(line, cwd=ROOT, env=own, capture_output=True, text=True, check=True).stdout
    if not given:
        return
    _, name, *fixed = shlex.split(recipe.partition(" --make ")[2])
    parser = Parser(prog=name)
    add_command(parser, command(name))
    flags = " ".join(word.replace(" ", r"\ ") for word in given)
    options = arguments(parser, target, fixed, {"MAKEFLAGS": f" -- {flags}", "MAKELEVEL": "1"})
    parser.parse_args(options)


def test_no_link_leads_nowhere(tmp_path):
    assert collect.collect(ROOT, tmp_path) == []
    every = {path.relative_to(tmp_path).with_suffix("").as_posix() for path in tmp_path.rglob("*.md")}
    listed = set(re.findall(r"(?m)^([\w/-]+)$", collect.contents(tmp_path)))
    assert every - {"index"} <= listed and len(every) > 40


def test_links_of_the_site(tmp_path):
    (tmp_path / "rtl" / "a").mkdir(parents=True)
    (tmp_path / "rtl" / "a" / "a.py").write_text("")
    text = "[up](../../README.md#x), [code](a.py), `[no](b)`, [web](https://a.b), [here](#c), [lost](b.md)\n"
    (tmp_path / "rtl" / "a" / "README.md").write_text(f"{text}\n```\n[no](link)\n```\n")
    (tmp_path / "README.md").write_text("[a folder](rtl/a), ![lost](p.png)\n")
    broken = collect.collect(tmp_path, tmp_path / "out")
    assert broken == ["README.md: ![](p.png) leads nowhere", "rtl/a/README.md: [lost](b.md) leads nowhere"]
    assert (tmp_path / "out" / "index.md").read_text().startswith("[a folder](rtl/a/README.md)")
    done = (tmp_path / "out" / "rtl" / "a" / "README.md").read_text()
    assert done.startswith("[up](../../index.md#x), code, `[no](b)`, [web](https://a.b), [here](#c), [lost](b.md)")
    assert "\n[no](link)\n" in done


def test_connections_are_those_of_the_rtl():
    top = build_top("AspChip", SensorParameters())
    top.elaborate()
    blocks, bits = architecture.connections(top)
    assert blocks["amp"] == "AmpCtrl" and blocks["encoder"] == "RunLength" and len(blocks) == 15
    assert bits["seq", "amp"] == 3 + len(SLOT)  # start, four_tap, hold_free and a slot's
    stream = 1 + top.phase.send.msg._dsl.Type.nbits  # val and msg forth
    assert bits["phase", "scan"] == bits["scan", "encoder"] == stream
    assert bits["encoder", "scan"] == bits["scan", "phase"] == 1  # rdy back
    assert ("amp", "encoder") not in bits


def test_diagrams_show_everything():
    drawn = diagrams.machine({"idle": 0, "run": 2, "b<c": 1}, [("idle", "run"), ("run", "b<c"), ("b<c", "idle")])
    root = xml.fromstring(drawn)
    texts = {"".join(element.itertext()) for element in root.iter()}
    assert {"0 idle", "1 b<c", "2 run", "idle to run", "run to b<c", "b<c to idle"} <= texts
    text = diagrams.matrix({"a": "A", "b": "B"}, {("a", "b"): 12})
    assert "a to b: 12 bits" in text and xml.fromstring(text).tag.endswith("svg")
    floors = diagrams.floors(next(iter(architecture.layers().values())))
    assert {"verif", "cells", "pixels", "models"} <= {"".join(e.itertext()) for e in xml.fromstring(floors).iter()}


def test_the_page_of_the_api_has_every_name(tmp_path):
    import talbot

    api.write(tmp_path)
    text = (tmp_path / "api.md").read_text()
    assert sorted(re.findall(r"\.\. (?:auto\w+|py:data):: (?:[\w.]+\.)?(\w+)", text)) == sorted(talbot.__all__)
    # After an automodule a bare name is that module's
    assert set(re.findall(r"\.\. auto(?:class|function):: (\w+)\.\w+\n", text)) == {"talbot"}


def test_docstrings_are_prose():
    lines = ["|code| and a*b of x_ `|kept|`", "    code * |"]
    api.as_text(None, "", "", None, None, lines)
    assert lines == [r"\|code\| and a\*b of x\_ `|kept|`", "    code * |"]


def test_a_warning_of_sphinx_is_a_failure(tmp_path):
    source = tmp_path / "source"
    source.mkdir()
    (source / "index.md").write_text("# Title\n\n[here](nowhere.md)\n")
    (said,) = site.build(source, tmp_path / "out", tmp_path / "trees")
    assert said.startswith("index.md:3: WARNING: ") and "nowhere.md" in said
    (source / "index.md").write_text("# Title\n")
    assert site.build(source, tmp_path / "out", tmp_path / "trees") == []
    assert "Title" in (tmp_path / "out" / "index.html").read_text()


def test_a_bad_folder_is_one_line(tmp_path, capsys):
    (tmp_path / "file").write_text("")
    assert run_command(site, ["--out", str(tmp_path / "file")]) == 2
    assert capsys.readouterr().err.count("\n") == 1


def test_the_gallery_moves(tmp_path, monkeypatch):
    monkeypatch.setattr(gallery, "FRAMES", 4)
    gallery.clip(tmp_path / "clip.webp")
    shutil.copyfile(tmp_path / "clip.webp", tmp_path / "edges.webp")
    still = "data:image/webp;base64,AAAA"
    for folder, name in ((".", "moves"), ("elsewhere", "stands")):
        gallery.picture(index.Card("", folder, "", "", [], still), tmp_path, tmp_path / name)
    with Image.open(tmp_path / "moves") as moving:
        assert moving.n_frames == gallery.FRAMES and moving.size == (gallery.SIDE, gallery.SIDE)
        first = moving.convert("RGB").tobytes()
        moving.seek(1)
        assert moving.convert("RGB").tobytes() != first
    assert (tmp_path / "stands").read_bytes() == bytes(3)
