"""What decides a piece of code: imports, re-exports, names in strings, processes, data files; nothing else."""

import os

import pytest

from talbot.base.sources import Tree, code

FILES = {
    "pkg/__init__.py": '"""Text."""\nfrom .near import used\nfrom .other import unused\n__all__ = ["unused", "used"]\n',
    "pkg/near.py": "from talbot.models.deep import value\nused = value\n",
    "pkg/other.py": "unused = 1\n",
    "models/deep.py": "value = 1\n",
    "models/own.py": "class Own: ...\n",
    "state/__init__.py": "import talbot.models.own\nready = True\n",
    "state/part.py": "",
    "tool/__init__.py": "",
    "tool/__main__.py": "from talbot.tool.inner import main\n",
    "tool/inner.py": 'PAGE = "page.html"\n',
    "tool/page.html": "<p>",
    "other/page.html": "<i>",
    "plain/x.py": "from talbot.pkg import used\n",
    "plain/process.py": 'import sys\ncommand = [sys.executable, "-m", "talbot.tool"]\n',
    "plain/program.py": 'PROGRAM = "import sys; from talbot.tool.inner import main; main()"\n',
    "plain/chosen.py": 'def of(name):\n    return import_module(f"talbot.platforms.{name}.layers")\n',
    "plain/lazy.py": "def f():\n    from talbot.state import part\n    return part\n",
    "plain/tests.py": 'command = ["python", "-m", "pytest"]\n',
    "plain/tests_started.py": 'PROGRAM = "import sys, pytest; sys.exit(pytest.main())"\n',
    "plain/documented.py": '"""As tool.inner does; see page.html."""\n',
    "platforms/a/layers.py": "A = 1\n",
    "platforms/b/layers.py": "B = 1\n",
    "__init__.py": "from .models.own import Own\nlazy = 1\n",
    "../conftest.py": "import talbot.models.own\n",
}


@pytest.fixture
def root(tmp_path):
    for name, text in FILES.items():
        path = tmp_path / "talbot" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return tmp_path


@pytest.mark.parametrize(
    "start, chosen, files",
    [
        ("talbot.plain.x", {}, "plain/x.py pkg/near.py models/deep.py"),
        ("talbot.pkg", {}, "pkg/__init__.py pkg/near.py pkg/other.py models/deep.py"),
        ("talbot.plain.process", {}, "plain/process.py tool/__init__.py tool/__main__.py tool/inner.py tool/page.html"),
        ("talbot.plain.program", {}, "plain/program.py tool/inner.py tool/page.html"),
        ("talbot.plain.chosen", {}, "plain/chosen.py platforms/a/layers.py platforms/b/layers.py"),
        ("talbot.plain.chosen", {"talbot.platforms": "a"}, "plain/chosen.py platforms/a/layers.py"),
        ("talbot.plain.lazy", {}, "plain/lazy.py state/part.py state/__init__.py models/own.py"),
        ("talbot.plain.tests", {}, "plain/tests.py ../conftest.py models/own.py"),
        ("talbot.plain.tests_started", {}, "plain/tests_started.py ../conftest.py models/own.py"),
        ("talbot.plain.documented", {}, "plain/documented.py"),
        ("platforms/a", {}, "platforms/a/layers.py"),
    ],
)
def test_what_decides(root, start, chosen, files):
    found = {os.path.relpath(path, root / "talbot") for path in Tree(root).closure([start], chosen)}
    assert found == set(files.split())


def test_another_text_is_another_digest(root):
    before, other = code("talbot.plain.x", root=root), code("talbot.plain.process", root=root)
    (root / "talbot/models/deep.py").write_text("value = 2\n")
    code_now = Tree(root)
    assert root / "talbot/models/deep.py" in code_now.closure(["talbot.plain.x"])
    from talbot.base import sources

    sources.forget()
    assert code("talbot.plain.x", root=root) != before and code("talbot.plain.process", root=root) == other


def test_a_start_that_is_none(root):
    with pytest.raises(KeyError, match="nowhere: neither a module nor a file"):
        Tree(root).closure(["nowhere"])


@pytest.mark.parametrize("damage", [lambda text: "", lambda text: text[:-9], lambda text: text.replace("deep", "own")])
def test_what_is_kept_of_texts_counts_only_where_it_is_whole(root, tmp_path, monkeypatch, damage):
    from talbot.base import sources

    monkeypatch.setattr(sources, "PARSED", tmp_path / "parsed.json")

    def found():
        sources.forget()
        sources._parsed.cache_clear()
        return code("talbot.plain.x", root=root)

    first = found()
    text = (tmp_path / "parsed.json").read_text()
    assert "models.deep" in text and found() == first
    (tmp_path / "parsed.json").write_text(damage(text))
    assert found() == first
    assert (tmp_path / "parsed.json").read_text() == text
