"""The sensor's die, drawn to scale from its parameters, with the parts that a frame used."""

import numpy as np

from talbot.models.parameters import FrameParameters, SensorParameters

DIE = 5e-3  # m, side of the thesis's die [Jayasuriya2017, Sec. 3.5.1]
BETA_COLOURS = {12.0: "#7fb3d5", 18.0: "#f5b971", 24.0: "#c39bd3"}
GRAY = "#b0b0b0"
LABEL = 110  # width that a label takes
WIDTH = 360  # of the die


def chip_svg(sensor: SensorParameters, frame: FrameParameters) -> str:
    """Die, pixel array with the window read, column lanes and row logic, and one tile enlarged, as SVG text."""
    rows, cols, pitch = sensor.array.rows, sensor.array.cols, sensor.array.pitch
    side = max(DIE, 1.3 * pitch * max(rows, cols))
    px = WIDTH / side
    w, h = cols * pitch * px, rows * pitch * px
    x, y = (WIDTH - w) / 2 + 10, (WIDTH - h) / 2 - 14
    parts = [_rect(0, 0, WIDTH, WIDTH, "#20262f", rx=6), _rect(x, y, w, h, "#3b4656")]
    parts += _window(sensor, frame, x, y, w, h)
    parts += _lanes(sensor, x, y + h + 5, w)
    parts.append(_rect(x - 20, y, 14, h, "#5f8f6a"))
    if h > LABEL / 3:
        parts.append(_text(x - 13, y + h / 2, "rows", 9, -90))
    below = max(w, LABEL)
    parts.append(_rect(x + (w - below) / 2, y + h + 32, below, 12, "#6b7b8d"))
    parts.append(_text(x + w / 2, y + h + 41, "encoder, registers, SPI", 9))
    parts.append(_text(WIDTH / 2, 14, f"die {side * 1e3:.3g} mm, pitch {pitch * 1e6:g} µm", 10))
    tile = _tile(sensor, frame, WIDTH + 24, 24, 46)
    view = f'viewBox="0 0 {WIDTH + 320} {WIDTH}" font-family="sans-serif"'
    label = f"the die with {rows} x {cols} pixels and {sensor.chip.lanes} converters, and the pixel types of one tile"
    view += f' role="img" aria-label="{label}"'
    return f'<svg class="broad" xmlns="http://www.w3.org/2000/svg" {view}>{"".join(parts + tile)}</svg>'


def _rect(x: float, y: float, w: float, h: float, fill: str, rx: float = 1, extra: str = "") -> str:
    return f'<rect x="{x:.2f}" y="{y:.2f}" width="{w:.2f}" height="{h:.2f}" rx="{rx}" fill="{fill}" {extra}/>'


def _text(
    x: float, y: float, text: object, size: int, turn: int = 0, fill: str = "#fff", anchor: str = "middle"
) -> str:
    place = f'x="{x:.1f}" y="{y:.1f}" font-size="{size}" fill="{fill}" text-anchor="{anchor}"'
    rotate = f' transform="rotate({turn} {x:.1f} {y:.1f})"' if turn else ""
    return f"<text {place}{rotate}>{text}</text>"


def _window(sensor: SensorParameters, frame: FrameParameters, x: float, y: float, w: float, h: float) -> list[str]:
    tile, win = sensor.tile, frame.window
    x0, x1 = win.col0 * tile.cols, min(sensor.array.cols, (win.col1 + 1) * tile.cols)
    y0, y1 = win.row0 * tile.rows, min(sensor.array.rows, (win.row1 + 1) * tile.rows)
    sx, sy = w / sensor.array.cols, h / sensor.array.rows
    wide, high, label = (x1 - x0) * sx, (y1 - y0) * sy, f"{y1 - y0} x {x1 - x0} pixels read"
    if wide > LABEL and high > LABEL / 6:
        text = _text(x + x0 * sx + wide / 2, y + y0 * sy + high / 2, label, 12, fill="#222")
    else:
        text = _text(x + w / 2, y - 8, label, 12)
    return [_rect(x + x0 * sx, y + y0 * sy, wide, high, "#e8c15a"), text]


def _lanes(sensor: SensorParameters, x: float, y: float, w: float) -> list[str]:
    lanes, step = sensor.chip.lanes, w / sensor.chip.lanes
    return [_rect(x + i * step + 1, y, max(step - 2, 0.5), 22, "#a9c3e0") for i in range(lanes)] + [
        _rect(x + w / 2 - 50, y + 3, 100, 16, "#a9c3e0"),
        _text(x + w / 2, y + 15, f"{lanes} converter lane{'s' if lanes > 1 else ''}", 11, fill="#222"),
    ]


def _tile(sensor: SensorParameters, frame: FrameParameters, x: float, y: float, cell: float) -> list[str]:
    tile = sensor.tile
    title = "one tile: grating orientation and type; faded = not read"
    parts = [_text(x, y - 8, title, 11, fill="currentColor", anchor="start")]
    for position, number in enumerate(tile.order):
        kind = tile.types[number]
        px, py = x + position % tile.cols * cell, y + position // tile.cols * cell
        colour, opacity = BETA_COLOURS.get(kind.beta, GRAY), f'opacity="{1 if frame.mask >> number & 1 else 0.2}"'
        parts.append(_rect(px + 1, py + 1, cell - 2, cell - 2, colour, 3, opacity))
        # Grating lines run across the direction gamma in which the response oscillates.
        angle = kind.gamma + np.pi / 2
        for shift in (-0.22, 0, 0.22):
            cx = px + cell / 2 + shift * cell * np.cos(kind.gamma)
            cy = py + cell / 2 - shift * cell * np.sin(kind.gamma)
            dx, dy = 0.24 * cell * np.cos(angle), -0.24 * cell * np.sin(angle)
            ends = f'x1="{cx - dx:.1f}" y1="{cy - dy:.1f}" x2="{cx + dx:.1f}" y2="{cy + dy:.1f}"'
            parts.append(f'<line {ends} stroke="#333" stroke-width="1.6" {opacity}/>')
        parts.append(_text(px + 5, py + 12, number, 9, fill="#222", anchor="start"))
    legend = y + tile.rows * cell + 20
    for i, beta in enumerate(sorted({t.beta for t in tile.types})):
        parts.append(_rect(x + 88 * i, legend, 12, 12, BETA_COLOURS.get(beta, GRAY)))
        parts.append(_text(x + 88 * i + 17, legend + 10, f"beta {beta:g}", 11, fill="currentColor", anchor="start"))
    return parts
