"""A layout in a shuttle's frame: moved into its place, straps as pins."""

from collections.abc import Collection, Sequence

from talbot.base.gds import db
from talbot.base.steps import StepError
from talbot.platforms.coriolis import CoriolisPlatform


def into_frame(layout: "db.Layout", frame: Sequence[float]) -> "db.Box":
    """Move the top cell's contents so that the box ``frame``, um, begins at 0, 0; where that box then is.

    Raises StepError where something is outside of it.
    """
    top, box = layout.top_cell(), db.DBox(*frame).to_itype(layout.dbu)
    if not top.bbox().inside(box):
        raise StepError(f"stream_out: {top.dbbox()} um: must be inside the frame {db.DBox(*frame)}")
    move = db.Trans(db.Point() - box.p1)
    top.transform(move)
    return box.transformed(move)


def mark_straps(layout: "db.Layout", supplies: Collection[str], tech: CoriolisPlatform) -> None:
    """Draw every piece of the highest metal with a text of ``supplies`` as a pin, all of it."""
    top, metal = layout.top_cell(), tech.metals[-1]
    pins = top.shapes(layout.layer(*metal.pin))
    texts = db.Texts([shape.text for shape in pins.each(db.Shapes.STexts) if shape.text.string in supplies])
    drawn = db.Region(top.begin_shapes_rec(layout.layer(*metal.gds))).merged()
    pins.insert(drawn.interacting(texts))
