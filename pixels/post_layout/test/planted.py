"""Faults planted in drawn layouts."""

from talbot.base.gds import read_gds


def swapped(spice, one, other):
    """The circuit with two of its ports at each other's places."""
    ports, devices = spice.split("\n", 1)
    names = {one: other, other: one}
    return "\n".join([ports, *(" ".join(names.get(w, w) for w in line.split()) for line in devices.splitlines()), ""])


def changed(path, out, change):
    """``path`` once ``change`` was made to its top cell."""
    layout = read_gds(path)
    change(layout, layout.top_cell())
    layout.write(str(out))
    return out
