"""Faults planted in drawn layouts."""

from talbot.base.gds import read_gds


def changed(path, out, change):
    """``path`` once ``change`` was made to its top cell."""
    layout = read_gds(path)
    change(layout, layout.top_cell())
    layout.write(str(out))
    return out
