"""HTML pages, each one file without a request: templates extend base.html; page.css and page.js are those of all.

A page that is given a ``card`` is listed by `base.page.index`.
"""

import base64
import contextlib
import io
import json
import re
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
from jinja2 import BytecodeCache, Environment, FileSystemLoader, StrictUndefined
from jinja2.bccache import Bucket
from markupsafe import Markup, escape
from PIL import Image as pillow
from PIL.Image import Image

from talbot.base.files import write
from talbot.base.paths import BUILD
from talbot.models.sealed import sealed, unsealed

FOLDER = Path(__file__).parent
TABLES = FOLDER / "tables.html"  # a page of `Section`s
CARD = (480, 340)  # px, of the picture on a card, at most
CARD_TILES = 4
# As people write them; in files, terminals and names they are ASCII
UNITS = (
    (r"^-(0\.?0*)(?=$| )", r"\1"),
    (r"\bum2\b", "µm²"),
    (r"\bW/m2\b", "W/m²"),
    (r"\bu(?=[mWJAV]\b)", "µ"),
    (r"(^|(?<=\d ))us\b", "µs"),
    (r"(?<=\d) x (?=\d)", " × "),
    (r"<=(?= ?-?[\d.])", "≤"),
    (r">=(?= ?-?[\d.])", "≥"),
)
# A heading, or what gets a box; neither tables nor charts hold others
BOXED = re.compile(
    r'<h[1-3][^>]*>(?P<heading>.*?)</h[1-3]>|(?P<sheet><div class="sheet">)'
    r'|<table\b.*?</table>|<svg\b[^>]*class="broad".*?</svg>',
    re.DOTALL,
)


class Tile(NamedTuple):
    """A figure at the top of a page. kind: 'good', 'bad', 'none' (not run) or ''."""

    value: str
    label: str
    kind: str = ""


@dataclass(frozen=True)
class Scale:
    """Legend of a picture: ``colours`` (n, 3), uint8, represent values from ``low`` to ``high``."""

    colours: npt.NDArray[np.uint8]
    low: float
    high: float
    unit: str = ""

    @property
    def src(self) -> str:
        """The bar as a data URL."""
        return data_url(pillow.fromarray(self.colours[None]))

    @property
    def low_text(self) -> str:
        """The lower end."""
        return f"{self.low:.3g}"

    @property
    def high_text(self) -> str:
        """The upper end."""
        return f"{self.high:.3g}"


@dataclass(frozen=True, eq=False)
class Picture:
    """A picture of a page. name: of its file, without a suffix. title: of its section, '' for none."""

    name: str
    title: str
    caption: str
    image: Image
    scale: Scale | None = None

    @cached_property
    def png(self) -> bytes:
        """The picture as PNG, encoded once for its file and for pages."""
        return encoded(self.image)

    @property
    def src(self) -> str:
        """The picture as a data URL."""
        return _url(self.png, "PNG")


@dataclass(frozen=True)
class Section:
    """A part of a page of tables. charts: SVG. rows: texts, None for what was not run; numbers: all but the first."""

    title: str = ""
    text: str = ""
    charts: Sequence[Markup] = ()
    pictures: Sequence[Picture] = ()
    head: Sequence[str] = ()
    rows: Iterable[Sequence[str | None]] = field(default_factory=tuple)
    numbers: bool = True
    kind: str = ""


def data_url(image: Image, kind: str = "PNG", **options: Any) -> str:
    """Return an image inside a page."""
    return _url(encoded(image, kind, **options), kind)


def encoded(image: Image, kind: str = "PNG", **options: Any) -> bytes:
    """Return the bytes of a file of an image."""
    out = io.BytesIO()
    image.save(out, kind, **options)
    return out.getvalue()


def _url(data: bytes, kind: str) -> str:
    return f"data:image/{kind.lower()};base64,{base64.b64encode(data).decode()}"


def units(value: object) -> str:
    """Return a text with its units as people write them: um2 as µm²."""
    text = value if isinstance(value, str) else str(value)
    for ascii_form, written in UNITS:
        text = re.sub(ascii_form, written, text)
    return text


def contained(html: str) -> Markup:
    """HTML in which what may be wider than a screen, a table, a broad chart or a sheet, has a box that scrolls.

    The box can be focused, and is named after the heading before it.
    """
    names: Counter[str] = Counter()
    heading = ""

    def box(match: re.Match[str]) -> str:
        """Return the matched element in its box; note the heading."""
        nonlocal heading
        if match["heading"] is not None:
            heading = Markup(match["heading"]).striptags()
            return match[0]
        kind = {"<table": "table", "<svg": "chart"}.get(match[0].split(maxsplit=1)[0].rstrip(">"), "pictures")
        name = f"{heading}: {kind}" if heading else kind
        names[name] += 1
        label = escape(f"{name} {names[name]}" if names[name] > 1 else name)
        start = (
            f'<div class="{"sheet " if match["sheet"] else ""}wide" tabindex="0" role="region" aria-label="{label}">'
        )
        return start if match["sheet"] else f"{start}{match[0]}</div>"

    return Markup(BOXED.sub(box, html))


def card(title: str, tiles: Sequence[Tile] = (), picture: Image | None = None) -> str:
    """Return a page's card in the index, as JSON."""
    src = ""
    if picture:
        small = picture.convert("RGB")
        small.thumbnail(CARD)
        src = data_url(small, "WEBP", quality=80)
    return json.dumps({"title": title, "tiles": tiles[:CARD_TILES], "picture": src})


class _Templates(BytecodeCache):
    """Compiled templates as files; one that is damaged counts as none, and where none can be written none is kept."""

    def load_bytecode(self, bucket: Bucket) -> None:
        """Load a template's code."""
        with contextlib.suppress(OSError):
            if (data := unsealed(self._file(bucket).read_bytes())) is not None:
                bucket.bytecode_from_string(bytes(data))

    def dump_bytecode(self, bucket: Bucket) -> None:
        """Keep a template's code."""
        with contextlib.suppress(OSError):
            write(self._file(bucket), sealed(bucket.bytecode_to_string()))

    def _file(self, bucket: Bucket) -> Path:
        return BUILD / "templates" / bucket.key


def render(template: Path, title: str, *, picture: Image | None = None, listed: bool = True, **values: Any) -> str:
    """HTML of a Jinja2 ``template`` with ``values``, text escaped. Raises jinja2.UndefinedError for a missing value.

    values: ``tiles``, a sequence of `Tile`, are at the top. listed: in the index, where ``picture`` is on its card.
    """
    loader = FileSystemLoader([template.parent, FOLDER])
    environment = Environment(
        loader=loader, autoescape=True, undefined=StrictUndefined, trim_blocks=True, bytecode_cache=_Templates()
    )
    environment.filters |= {"units": units, "contained": contained}
    environment.globals["parts"] = environment.get_template("parts.html").module
    values = {"tiles": ()} | values
    shown = card(title, values["tiles"], picture) if listed else ""
    text = environment.get_template(template.name).render(title=title, card=shown, **values)
    return text.encode("utf-8", "surrogateescape").decode("utf-8", "replace")  # a name of a file may be no UTF-8
