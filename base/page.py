"""HTML pages: every template extends base.html, which holds the style of all."""

from pathlib import Path
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined

BASE = Path(__file__).with_name("base.html")


def render(template: Path, **values: Any) -> str:
    """HTML of a Jinja2 ``template`` with ``values``, text escaped. Raises jinja2.UndefinedError for a missing value."""
    loader = FileSystemLoader([template.parent, BASE.parent])
    environment = Environment(loader=loader, autoescape=True, undefined=StrictUndefined)
    return environment.get_template(template.name).render(**values)
