"""The documents site, from the READMEs, docs/ and docstrings: build/site/index.html.

Nothing is fetched. A warning, a link to nothing among them, fails.
"""

import importlib.util
import io
import re
import tempfile
from argparse import ArgumentParser, Namespace
from pathlib import Path

from talbot.base.command import failures
from talbot.base.files import staged
from talbot.base.paths import RESULTS, ROOT
from talbot.base.progress import Steps
from talbot.models.parameters import ParameterError
from talbot.site import api
from talbot.site.collect import collect, contents

STEPS = "documents", "API", "HTML"
COLOUR = re.compile(r"\x1b\[[\d;]*m")
PACKAGES = "sphinx", "myst_parser", "furo"
SETTINGS = {
    "project": "Talbot",
    "author": "The Talbot authors",
    "copyright": "the Talbot authors, MIT",
    "extensions": ["myst_parser", "sphinx.ext.autodoc"],
    "html_theme": "furo",
    "html_title": "Talbot",
    "html_copy_source": False,
    "html_show_sourcelink": False,
    "default_role": "code",
    "highlight_language": "none",
    "autodoc_member_order": "bysource",
    "autodoc_typehints_format": "short",
    "myst_heading_anchors": 4,
    "myst_enable_extensions": ["attrs_block"],
    "exclude_patterns": [],
}


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot site`."""
    parser.add_argument("--out", type=Path, default=RESULTS / "site", help="folder of the site")


def run(options: Namespace) -> int:
    """Build the site and print where it is; 1 where a link leads nowhere or Sphinx warns."""
    if not (ROOT / "pyproject.toml").is_file():
        raise ParameterError(f"root = {ROOT}: must be the repository, whose documents the site is made of")
    for package in PACKAGES:
        if not importlib.util.find_spec(package):
            raise ParameterError(f"{package} = not installed: make setup")
    with tempfile.TemporaryDirectory(prefix="talbot-") as folder, Steps(STEPS, lines=True) as steps:
        source = Path(folder) / "source"
        steps.note("documents")
        if broken := collect(ROOT, source):
            return failures(broken)
        steps.note("API")
        api.write(source)
        (source / "index.md").write_text(
            (source / "index.md").read_text(encoding="utf-8") + contents(source), encoding="utf-8"
        )
        steps.note("HTML")
        with staged(options.out) as part:
            warnings = build(source, part, Path(folder) / "doctrees")
            if warnings:
                return failures(warnings)
    print(f"look at {options.out / 'index.html'}")
    return 0


def build(source: Path, out: Path, doctrees: Path) -> list[str]:
    """HTML of the documents in ``source``; returns Sphinx's warnings."""
    from sphinx.application import Sphinx
    from sphinx.util.docutils import docutils_namespace

    said = io.StringIO()
    with docutils_namespace():
        app = Sphinx(source, None, out, doctrees, "html", dict(SETTINGS), status=None, warning=said, freshenv=True)
        app.connect("autodoc-process-docstring", api.as_text)
        app.build()
    text = COLOUR.sub("", said.getvalue()).replace(f"{source}/", "")
    return [line for line in text.splitlines() if line.strip()]
