"""Rows of adjacent transistors, with switched-off transistors at their ends."""

from collections.abc import Iterable, Mapping

from talbot.pixels.analog_layout.device import Device, snap
from talbot.pixels.analog_layout.strip_plan import DROP_PITCH, GAP, Placed
from talbot.pixels.circuits.netlist import Transistor


def dummies(name: str, like: Device) -> dict[str, Device]:
    """Transistors of two fingers that are off, for both ends of a row of ``like``."""
    t = like.transistor
    width = round(2 * like.finger_um, 3)
    return {
        f"{name}_{end}": Device(Transistor(f"{name}_{end}", t.bulk, t.bulk, t.bulk, t.bulk, t.role, width, t.l), 2)
        for end in ("west", "east")
    }


def row(d: Mapping[str, Device], names: Iterable[str], axis: float, room: float = 0.0) -> tuple[Placed, ...]:
    """Place adjacent devices about ``axis``; room: additional um between them."""
    devices = [d[name] for name in names]
    rooms = [snap(max(device.width_um + GAP, 3 * DROP_PITCH) + room) for device in devices]
    x, placed = snap(axis - sum(rooms) / 2), list[Placed]()
    for device, wide in zip(devices, rooms, strict=True):
        placed.append(Placed(device, snap(x + (wide - device.width_um) / 2), x, x + wide))
        x = snap(x + wide)
    return tuple(placed)
