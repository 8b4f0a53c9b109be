"""The documents: examples run, make lines are understood, links lead somewhere."""

import os
import re
import shlex
import subprocess

import pytest

from talbot.base.command import Parser, add_command
from talbot.base.command import main as run_command
from talbot.base.paths import ROOT
from talbot.commands import command
from talbot.make import arguments
from talbot.site import api, collect
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
