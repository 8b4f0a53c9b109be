"""Diagrams as SVG in the page's own ink: floors, blocks and their connections, state machines."""

from collections.abc import Mapping, Sequence
from html import escape

INK, SOFT, ACCENT = "currentColor", "#8a94a344", "#4878a8"


def _svg(width: float, height: float, parts: Sequence[str], label: str) -> str:
    style = (
        f'font-family="system-ui, sans-serif" font-size="12" style="max-width:{width:.0f}px;width:100%" fill="{INK}"'
    )
    size = f'viewBox="0 0 {width:.0f} {height:.0f}" role="img" aria-label="{escape(label)}"'
    return f'<svg xmlns="http://www.w3.org/2000/svg" {size} {style}>{"".join(parts)}</svg>'


def _box(x: float, y: float, width: float, height: float, fill: str = SOFT) -> str:
    place = f'x="{x:.1f}" y="{y:.1f}" width="{width:.1f}" height="{height:.1f}"'
    return f'<rect {place} rx="4" fill="{fill}" stroke="{INK}" stroke-opacity=".4"/>'


def _text(x: float, y: float, text: object, anchor: str = "middle", size: float = 12) -> str:
    place = f'x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" font-size="{size:.3g}" dominant-baseline="central"'
    return f"<text {place}>{escape(str(text))}</text>"


def floors(layers: Sequence[str], width: float = 640, high: float = 34) -> str:
    """Floors from the top down, 'a | b' side by side; each imports from those below it."""
    parts = []
    for k, layer in enumerate(layers):
        rooms = [room.strip() for room in layer.split("|")]
        for i, room in enumerate(rooms):
            x, y, wide = i * width / len(rooms) + 1, k * (high + 6) + 1, width / len(rooms) - 6
            parts += [_box(x, y, wide, high), _text(x + wide / 2, y + high / 2, room)]
    return _svg(width, len(layers) * (high + 6), parts, f"floors from the top down: {', '.join(layers)}")


def matrix(blocks: Mapping[str, str], bits: Mapping[tuple[str, str], int], cell: float = 58, high: float = 30) -> str:
    """Blocks (name -> class) on the diagonal; in the row of one and the column of another the bits from it to that."""
    names = list(blocks)
    parts = []
    for i, name in enumerate(names):
        parts += [
            _box(i * cell + 1, i * high + 1, cell - 2, high - 2, f"{ACCENT}66"),
            _text((i + 0.5) * cell, (i + 0.36) * high, name, size=10 if len(name) < 11 else 8),
        ]
        small = min(7.0, 1.6 * (cell - 4) / len(blocks[name]))  # a letter is 0.6 of the size wide
        parts.append(_text((i + 0.5) * cell, (i + 0.7) * high, blocks[name], size=small))
        for k, other in enumerate(names):
            if count := bits.get((name, other)):
                title = f"<title>{escape(name)} to {escape(other)}: {count} bits</title>"
                number = _text((k + 0.5) * cell, (i + 0.5) * high, count)
                parts.append(f"<g>{title}{_box(k * cell + 9, i * high + 5, cell - 18, high - 10)}{number}</g>")
    return _svg(len(names) * cell, len(names) * high, parts, f"bits from block to block of {', '.join(names)}")


def machine(states: Mapping[str, int], transitions: Sequence[tuple[str, str]], high: float = 30) -> str:
    """States from the top down with their codes; transitions down the list on the right, back up it on the left."""
    order = {name: k for k, name in enumerate(sorted(states, key=lambda name: states[name]))}
    reach = 18 + 13 * max((abs(order[a] - order[b]) for a, b in transitions), default=0)
    wide, parts = 108, []
    for name, k in order.items():
        parts.append(_box(reach, k * high + 3, wide, high - 6, f"{ACCENT}66"))
        parts.append(_text(reach + wide / 2, (k + 0.5) * high, f"{states[name]} {name}"))
    parts.append(
        f'<defs><marker id="to" viewBox="0 0 6 6" refX="5" refY="3" markerWidth="6" markerHeight="6" orient="auto">'
        f'<path d="M0 0 6 3 0 6z" fill="{INK}"/></marker></defs>'
    )
    for a, b in transitions:
        down = order[b] > order[a]
        x, far = (reach + wide, 13 * (order[b] - order[a])) if down else (reach, 13 * (order[b] - order[a]) - 3)
        start, end = ((order[s] + 0.5) * high + shift for s, shift in ((a, 4 if down else -4), (b, -4 if down else 4)))
        bend = x + far * 1.2 + (6 if down else -6)
        curve = f"M{x:.1f} {start:.1f}C{bend:.1f} {start:.1f} {bend:.1f} {end:.1f} {x:.1f} {end:.1f}"
        title = f"<title>{escape(a)} to {escape(b)}</title>"
        parts.append(f'<path d="{curve}" fill="none" stroke="{INK}" marker-end="url(#to)">{title}</path>')
    words = ", ".join(f"{a} to {b}" for a, b in transitions)
    return _svg(2 * reach + wide, len(order) * high, parts, f"states {', '.join(order)}; transitions {words}")
