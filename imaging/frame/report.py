"""The report: one self-contained page from the summary, the pictures and the charts."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from markupsafe import Markup
from PIL.Image import Image

from talbot.base import page
from talbot.base.page import Picture, Scale, Tile
from talbot.imaging.frame.figures import (
    camera_line,
    digital_line,
    energy_line,
    exposure_line,
    full_line,
    light_line,
    trims_line,
)
from talbot.imaging.frame.merit import decibels, nothing_sent, table
from talbot.imaging.frame.pictures import sprite
from talbot.models.parameters.sources import Sourced

VIEW = 256  # px, width of a view on a page at most
SHEET = 1600  # px, width of all views on a page at most


@dataclass(frozen=True, eq=False)
class Views:
    """Views of a light field for the slider. columns: views along an axis. sprite: all, edge to edge."""

    caption: str
    columns: int
    sprite: Image
    scale: Scale | None = None

    @classmethod
    def of(cls, caption: str, views: Sequence[Sequence[Image]], scale: Scale | None = None) -> "Views":
        """Pictures, row by row."""
        return cls(caption, len(views), sprite(views, min(VIEW, SHEET // len(views))), scale)

    @cached_property
    def src(self) -> str:
        """The sprite as a data URL."""
        return page.data_url(self.sprite, "WEBP", quality=82)


FIRST = "differences", "depth", "image"  # names of pictures, one of which is on the card


def agreement(differ: int, unit: str = "values", of: str = "") -> Tile:
    """Return whether the chip and the golden model agree. differ: how many do not."""
    about = f"chip against golden model{of}"
    return Tile(f"{differ} {unit} differ", about, "bad") if differ else Tile("byte for byte", about, "good")


def headline(s: dict[str, Any]) -> list[Tile]:
    """Return the figures of the summary ``s`` to see first."""
    return [
        agreement(s["stream_mismatches"] or s["decoded_mismatches"]),
        Tile(f"{s['compression_ratio']:.1f} : 1", f"{s['stream_bytes']:,} of {s['raw_bytes']:,} bytes"),
        Tile(decibels(s["snr_db"]), f"SNR of the decoded samples ({nothing_sent(s)})"),
        Tile(f"{100 * s['conversions_left_out'] / max(s['samples'], 1):.1f} %", "of the conversions left out"),
        Tile(f"{1e3 * s['frame_s_at_clock']:.1f} ms", f"a frame, {s['cycles']:,} cycles"),
        Tile(f"{s['energy_uj']['total']:.1f} to {s['energy_uj']['total_high']:.1f} uJ", "a frame"),
    ]


def render(
    summary: dict[str, Any],
    pictures: Sequence[Picture],
    chip: str,
    sheets: Sequence[Picture],
    views: Sequence[Views],
    where: Sequence[Markup],
    errors: Sequence[Markup],
    assumed: Sequence[Sourced] = (),
) -> str:
    """Return the page as HTML. chip: SVG text. where, errors: SVG of where cycles went, of error against time.

    views: light fields side by side, of as many views. assumed: parameters, and where they come from.
    """
    texts = {
        "camera": camera_line(summary),
        "exposure": exposure_line(summary),
        "energy": energy_line(summary),
        "digital": digital_line(summary),
        "light": light_line(summary),
        "trims": trims_line(summary),
        "full": full_line(summary),
    }
    shown = {"pictures": pictures, "sheets": sheets, "views": views, "where": where, "errors": errors}
    return page.render(
        Path(__file__).with_name("report.html"),
        f"{summary['scene']}: one frame in {summary['mode']} mode",
        picture=next((p.image for p in pictures if p.name in FIRST), None),
        s=summary,
        tiles=headline(summary),
        merit=table(summary),
        chip=Markup(chip),
        assumed=assumed,
        **texts,
        **shown,
    )
