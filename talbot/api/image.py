"""Arrays and figures that a notebook shows as pictures."""

import base64
import io
from typing import Any

import numpy as np
import numpy.typing as npt
from PIL.Image import Image as Picture

from talbot.imaging.frame import pictures

WIDTH = 288  # px that a picture has at least


def png(picture: Picture) -> bytes:
    """Return a picture as a PNG file."""
    out = io.BytesIO()
    picture.save(out, "PNG")
    return out.getvalue()


def embedded(data: bytes) -> str:
    """Return a PNG file as an element of a page."""
    return f'<img src="data:image/png;base64,{base64.b64encode(data).decode()}">'


class Image(np.ndarray):
    """A NumPy array that a notebook shows: (rows, cols) in gray, dark to bright; (n, rows, cols) as n signed images."""

    @classmethod
    def of(cls, values: npt.ArrayLike) -> "Image":
        """Return the same values, float64."""
        return np.ascontiguousarray(values, float).view(cls)

    def _repr_png_(self) -> bytes | None:
        if self.ndim not in (2, 3) or 0 in self.shape:
            return None
        values = np.nan_to_num(np.asarray(self))
        if self.ndim == 2:
            low, high = (float(end) for end in np.quantile(values, (0.005, 0.995)))
            return png(pictures.enlarge(pictures.gray(values, min(low, 0.0), high), WIDTH))
        images = [pictures.signed(plane, float(np.abs(values).max())) for plane in values]
        return png(pictures.contact_sheet(images, [str(i) for i in range(len(images))], min(len(images), 8)))


def table(values: dict[str, Any]) -> str:
    """Names and values as an HTML table."""
    rows = "".join(f"<tr><th>{name}</th><td>{text(value)}</td></tr>" for name, value in values.items())
    return f"<table>{rows}</table>"


def text(value: Any) -> str:
    """Return a value for people: five digits, '-' for None."""
    return "-" if value is None else f"{value:.5g}" if isinstance(value, float) else str(value)
