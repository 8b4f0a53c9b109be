"""Error against run time and cost: the sweeps of `make tradeoff`, and sweeps of one's own."""

import io
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from matplotlib.figure import Figure

from talbot.api.image import embedded, text
from talbot.base.charts import own_style, save
from talbot.imaging.tradeoff.sweeps import SWEEPS, measured
from talbot.models.parameters import check_choice


@dataclass(frozen=True, eq=False, repr=False)
class Tradeoff:
    """A table and its plot. text: varied and measured quantities. rows: a dict for each point. figure: Matplotlib's."""

    text: str
    rows: Sequence[dict[str, Any]]
    figure: Figure

    def __repr__(self) -> str:
        return f"<Tradeoff of {len(self.rows)} points: {', '.join(self.rows[0])}>"

    def _repr_png_(self) -> bytes:
        out = io.BytesIO()
        save(self.figure, out)
        return out.getvalue()

    def _repr_html_(self) -> str:
        head = "".join(f"<th>{name}</th>" for name in self.rows[0])
        body = "".join(f"<tr>{''.join(f'<td>{text(v)}</td>' for v in row.values())}</tr>" for row in self.rows)
        return f"<p>{self.text}</p>{embedded(self._repr_png_())}<table><tr>{head}</tr>{body}</table>"


def tradeoff(name: str, *, quick: bool = False) -> Tradeoff:
    """Measure one of the trade-offs of `make tradeoff`.

    name: divider, threshold, fixed_pattern, exposure, light, lens, views, pupil, precision, noise, light_field,
    light_field_sensor, depth, polarization or spectra. quick: fewer points of a smaller array.
    Raises ParameterError, ToolError.
    """
    check_choice("name", name, list(SWEEPS))
    rows = measured(name, quick)
    with own_style():
        figure = SWEEPS[name].plot(rows)
    return Tradeoff(" ".join((SWEEPS[name].__doc__ or "").split()), rows, figure)
