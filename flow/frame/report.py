"""The report: one self-contained page from the summary, the pictures and the charts."""

import base64
import io
from pathlib import Path

from markupsafe import Markup

from base import page


def inline(image):
    """A Pillow image as a data URL."""
    out = io.BytesIO()
    image.save(out, "PNG")
    return "data:image/png;base64," + base64.b64encode(out.getvalue()).decode()


def headline(s):
    """The figures to see first: list of dicts label, value, kind."""
    right = s["stream_mismatches"] == 0 and s["decoded_mismatches"] == 0
    psnr = "exact" if s["psnr_db"] is None else f"{s['psnr_db']:.1f} dB"
    tiles = [
        (
            "byte for byte" if right else f"{s['stream_mismatches']} bytes differ",
            "chip against golden model",
            "good" if right else "bad",
        ),
        (f"{s['compression_ratio']:.1f} : 1", f"{s['stream_bytes']:,} of {s['raw_bytes']:,} bytes", ""),
        (psnr, "decoded samples against the analog values", ""),
        (f"{100 * s['conversions_left_out'] / max(s['samples'], 1):.1f} %", "of the conversions left out", ""),
        (f"{1e3 * s['frame_s_at_clock']:.1f} ms", f"a frame, {s['cycles']:,} cycles", ""),
        (f"{s['energy_uj']['total']:.1f} uJ", "a frame", ""),
    ]
    return [{"value": value, "label": label, "kind": kind} for value, label, kind in tiles]


def render(summary, pictures, chip, sheets, where, errors):
    """HTML text.

    pictures: list of (caption, image). sheets: list of (title, caption, image).
    chip, where, errors: SVG text, and lists of it.
    """
    return page.render(
        Path(__file__).with_name("report.html"),
        s=summary,
        tiles=headline(summary),
        chip=Markup(chip),
        pictures=[{"caption": caption, "src": inline(image)} for caption, image in pictures],
        sheets=[{"title": title, "caption": caption, "src": inline(image)} for title, caption, image in sheets],
        where=[Markup(c) for c in where],
        errors=[Markup(c) for c in errors],
    )
