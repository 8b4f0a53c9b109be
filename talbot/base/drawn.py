"""SVG of the charts of `base.charts`, kept: a page that shows one again does without Matplotlib."""

from typing import Any, Literal

from markupsafe import Markup

from talbot.base.kept import kept


def drawn(chart: Literal["bars", "curves"], *arguments: object, **named: object) -> Markup:
    """Return the SVG of a chart of these arguments, now or earlier."""
    return kept("charts", _drawn, chart, arguments, named)


def _drawn(chart: str, arguments: tuple[Any, ...], named: dict[str, Any]) -> Markup:
    from talbot.base import charts

    return charts.svg(getattr(charts, chart)(*arguments, **named))
