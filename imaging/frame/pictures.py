"""Arrays to pictures for the eye, as Pillow images."""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
from PIL import Image as pillow
from PIL import ImageDraw, ImageFont
from PIL.Image import Image, Resampling

from talbot.base.page import Scale
from talbot.models.parameters import TileParameters

Values = npt.NDArray[np.floating]

VIEW, OVERVIEW = 96, 288  # px, sides of the pictures on a sheet
INK, PAPER = (24, 28, 36), (255, 255, 255)
COLD, WARM = np.array([33, 102, 172]), np.array([178, 24, 43])
CONVERTED, ZERO, UNREAD = (250, 204, 92), (44, 52, 66), (205, 210, 218)


def gray(values: Values, low: float = 0.0, high: float = 1.0, gamma: float = 2.2) -> Image:
    """8-bit gray of linear values (rows, cols), display gamma applied; ``low`` is black, ``high`` white."""
    span = max(high - low, np.finfo(float).tiny)
    unit = np.clip((np.asarray(values, float) - low) / span, 0, 1)
    return pillow.fromarray(np.round(255 * unit ** (1 / gamma)).astype(np.uint8), "L")


def grays(field: Values, high: float) -> list[list[Image]]:
    """Each view of a light field l[v, u, y, x], black at 0, white at ``high``."""
    return [[gray(view, high=high) for view in row] for row in field]


def brightest(values: Values) -> float:
    """Return the value shown as white: all but a thousandth is darker."""
    return max(float(np.quantile(values, 0.999)), 1e-6)


def signed(values: Values, scale: float) -> Image:
    """Signed values (rows, cols) as blue (-scale) .. white (0) .. red (+scale)."""
    unit = np.clip(np.asarray(values, float) / max(scale, np.finfo(float).tiny), -1, 1)[..., None]
    # The square root lifts small responses, of which there are most.
    weight = np.sqrt(np.abs(unit))
    rgb = 255 * (1 - weight) + np.where(unit < 0, COLD, WARM) * weight
    return pillow.fromarray(np.round(rgb).astype(np.uint8), "RGB")


def signed_codes(codes: npt.NDArray[np.integer], scale: float) -> Image:
    """`signed` of codes -256..255, by a table."""
    steps = np.arange(-256.0, 256.0)
    table = np.asarray(signed(steps[None], scale))[0]
    return pillow.fromarray(table[codes.astype(np.intp) + 256], "RGB")


def depth(values: Values, low: float, high: float) -> Image:
    """Values (rows, cols) on the scale of `depth_colours`, ``low`` to ``high``; NaN is gray."""
    unit = np.clip((np.asarray(values, float) - low) / max(high - low, np.finfo(float).tiny), 0, 1)
    codes = np.nan_to_num(np.round(255 * unit)).astype(np.uint8)
    rgb = np.where(np.isnan(values)[..., None], UNREAD, depth_colours()[codes])
    return pillow.fromarray(rgb.astype(np.uint8), "RGB")


def depth_colours() -> npt.NDArray[np.uint8]:
    """Return the colours of `depth`, (256, 3), from near to far."""
    from matplotlib import colormaps

    return np.round(255 * colormaps["viridis"](np.linspace(0, 1, 256))[:, :3]).astype(np.uint8)


def angle(values: Values) -> Image:
    """Angles modulo pi in rad (rows, cols) on the cyclic scale of `angle_colours`; NaN is gray."""
    codes = np.nan_to_num(np.floor(256 * ((values / np.pi + 0.5) % 1))).astype(np.uint8)
    rgb = np.where(np.isnan(values)[..., None], UNREAD, angle_colours()[codes])
    return pillow.fromarray(rgb.astype(np.uint8), "RGB")


def angle_colours() -> npt.NDArray[np.uint8]:
    """Return the colours of `angle` from -pi/2 to pi/2, (256, 3)."""
    from matplotlib import colormaps

    return np.round(255 * colormaps["twilight"](np.linspace(0, 1, 256))[:, :3]).astype(np.uint8)


def marked(values: Values, mask: npt.NDArray[np.bool_]) -> Image:
    """`gray` of values (rows, cols), yellow where the mask is True."""
    rgb = np.where(mask[..., None], CONVERTED, np.asarray(gray(values))[..., None])
    return pillow.fromarray(rgb.astype(np.uint8), "RGB")


def signed_scale(scale: float, unit: str) -> Scale:
    """Return the colours of `signed`."""
    return Scale(np.asarray(signed(np.linspace(-scale, scale, 511)[None], scale))[0], -scale, scale, unit)


def gray_scale(low: float, high: float, unit: str) -> Scale:
    """Return the colours of `gray`."""
    return Scale(np.asarray(gray(np.linspace(low, high, 511)[None], low, high).convert("RGB"))[0], low, high, unit)


def decisions(read: npt.NDArray[np.bool_], converted: npt.NDArray[np.bool_]) -> Image:
    """Which samples were converted (yellow), judged zero (dark) or not read (light): bool arrays (rows, cols)."""
    rgb = np.where(read[..., None], np.where(converted[..., None], CONVERTED, ZERO), UNREAD)
    return pillow.fromarray(rgb.astype(np.uint8), "RGB")


def enlarge(image: Image, width: int) -> Image:
    """Whole-number enlargement to at least ``width`` pixels, so that pixels stay square and sharp."""
    factor = max(1, -(-width // image.width))
    return image.resize((image.width * factor, image.height * factor), Resampling.NEAREST)


def contact_sheet(
    images: Sequence[Image], labels: Sequence[str], columns: int, cell: int = 120, aspect: float = 1.0
) -> Image:
    """Images of one size in a labelled grid, ``cell`` pixels wide. aspect: width over height of one of their pixels."""
    font = ImageFont.load_default(13)
    width, height = images[0].size
    size = (cell, max(1, round(cell * height / (width * aspect))))
    gap, caption, rows = 8, 18, -(-len(images) // columns)
    sheet = pillow.new("RGB", (columns * (size[0] + gap) + gap, rows * (size[1] + caption + gap) + gap), PAPER)
    draw = ImageDraw.Draw(sheet)
    for i, (image, label) in enumerate(zip(images, labels, strict=True)):
        x = gap + i % columns * (size[0] + gap)
        y = gap + i // columns * (size[1] + caption + gap)
        sheet.paste(image.convert("RGB").resize(size, Resampling.NEAREST), (x, y))
        draw.text((x, y + size[1] + 1), label, fill=INK, font=font)
    return sheet


def edge_sheet(edges: Values, tile: TileParameters, scale: float) -> Image:
    """Return the 24 edge images (n_types, tile_rows, tile_cols) as a contact sheet, one row a beta."""
    images = [signed(edge, scale) for edge in edges]
    labels = [f"{t.beta:g}, {t.gamma_deg:g}°{' sin' if t.alpha else ' cos'}" for t in tile.types]
    return contact_sheet(images, labels, columns=max(1, len(images) // 3), aspect=tile.cols / tile.rows)


def view_sheet(light_field: Values) -> Image:
    """Return the views l[v, u, y, x] in their order, dark to bright by the field's own maximum."""
    high = float(light_field.max()) or 1.0
    v, u = light_field.shape[:2]
    images = [gray(light_field[j, i], high=high) for j in range(v) for i in range(u)]
    return contact_sheet(images, [f"v{j - v // 2:+d} u{i - u // 2:+d}" for j in range(v) for i in range(u)], u, VIEW)


def sprite(images: Sequence[Sequence[Image]], width: int) -> Image:
    """Views [v][u] of one size edge to edge, each at most ``width`` pixels wide."""
    first = images[0][0]
    size = min(width, first.width), max(1, round(first.height * min(1.0, width / first.width)))
    sheet = pillow.new(first.mode, (len(images[0]) * size[0], len(images) * size[1]))
    for v, row in enumerate(images):
        for u, image in enumerate(row):
            sheet.paste(image.resize(size, Resampling.BOX), (u * size[0], v * size[1]))
    return sheet


def overview(named: Sequence[tuple[str, Image]]) -> Image:
    """Return the run's pictures side by side, each with its name."""
    square = [image.convert("RGB").resize((OVERVIEW, OVERVIEW), Resampling.LANCZOS) for _, image in named]
    return contact_sheet(square, [name for name, _ in named], len(named), OVERVIEW)
