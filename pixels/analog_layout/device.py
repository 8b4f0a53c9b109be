"""A transistor in fingers, with its gates in a bar, its drains and sources in straps, and dummies at its ends.

    rail     ===================      a tap and a strap of the supply; its middle is RAIL below the diffusion
    sources  ------------------       strap of the first metal, S
    . . . . .|..|..|..|..|.. . .      diffusion; each finger is a gate
    drains   ------------------       strap of the first metal, D, over the middle of the fingers
    . . . . .|..|..|..|..|.. . .
    gates    ==================       bar of poly, strap of the first metal, G

A row of n transistors is upright, one of p transistors upside down: gates face the middle of a strip.
"""

from dataclasses import dataclass, replace
from typing import NamedTuple, Self

from talbot.models.parameters import ParameterError, check_int
from talbot.pixels.circuits.netlist import Transistor
from talbot.pixels.layout.canvas import CONTACT_UM, Canvas
from talbot.platforms.analog import AnalogMasks

# um
GATE_SPACE = 0.28  # diffusion between two gates, with a contact
DIFFUSION_END = 0.265  # diffusion beyond the last gate, with a contact
POLY_END = 0.13  # poly beyond the gate
GATE_BAR = 0.33  # from the diffusion to the centre of the gates' bar
SOURCE = 0.34  # from the diffusion to the centre of the source's strap
RAIL = 0.96  # from the rail's centre to the diffusion
STRAP = 0.32  # width of a strap
BAR_HALF = 0.135  # half width of the bar of poly
PAD = 0.165  # half width of a pad of poly
CONTACT_PITCH = 0.34  # along a finger
CONTACT_IN = 0.12  # diffusion around a contact
IMPLANT = 0.125
WELL_AROUND = 0.20
LOW_AROUND = 0.20
NITRIDE = 0.10
MAX_FINGER = 5.0  # height of a finger that is chosen here
GRID = 0.005


def snap(um: float) -> float:
    """Return the nearest length on the grid."""
    return round(um / GRID) * GRID


class Strap(NamedTuple):
    """A net's segment on a metal, from ``left`` to ``right`` at ``y``, um.

    fixed: it must not be extended.
    end: terminal of its transistor: g, d or s.
    railed: it is on the rail.
    """

    net: str
    left: float
    right: float
    y: float
    fixed: bool = False
    end: str = ""
    railed: bool = False


@dataclass(frozen=True)
class Device:
    """A transistor drawn in ``fingers``.

    dummies: a switched-off gate at each end, with its outer diffusion on the rail.
    swapped: a single finger's drain is in the west.
    """

    transistor: Transistor
    fingers: int
    dummies: bool = False
    swapped: bool = False

    def __post_init__(self) -> None:
        t = self.transistor
        check_int(f"{t.name} fingers", self.fingers, 1, 100)
        if self.fingers > 1 and self.fingers % 2:
            raise ParameterError(f"{t.name} fingers = {self.fingers}: must be 1 or even, sources at both ends")
        if abs(self.finger_um / 0.005 - round(self.finger_um / 0.005)) > 1e-6:
            raise ParameterError(
                f"{t.name} fingers = {self.fingers}: must divide w = {t.w:g} um on the grid of 0.005 um"
            )

    @classmethod
    def of(cls, transistor: Transistor, tallest: float = MAX_FINGER, dummies: bool = False) -> Self:
        """Return the device with its fingers, else with the fewest that are low enough; one below 2 um."""
        if transistor.fingers:
            return cls(transistor, transistor.fingers, dummies)
        if transistor.w < 2:
            return cls(transistor, 1, dummies)
        for fingers in range(2, 101, 2):
            steps = transistor.w / fingers / 0.005
            if transistor.w / fingers <= tallest and abs(steps - round(steps)) < 1e-6:
                return cls(transistor, fingers, dummies)
        raise ParameterError(
            f"{transistor.name} w = {transistor.w:g}: must be fingers of at most {tallest:g} um on the grid"
        )

    @property
    def finger_um(self) -> float:
        """Width of a finger."""
        return self.transistor.w / self.fingers

    @property
    def pitch_um(self) -> float:
        """Return the pitch of the gates."""
        return self.transistor.l + GATE_SPACE

    @property
    def width_um(self) -> float:
        """Return the width of its diffusion."""
        gates = self.fingers + 2 * self.dummies
        return gates * self.transistor.l + (gates - 1) * GATE_SPACE + 2 * DIFFUSION_END

    @property
    def off(self) -> list[Transistor]:
        """The dummies as transistors."""
        t = self.transistor
        if not self.dummies:
            return []
        outer = (t.source, t.source if self.fingers > 1 else t.drain)
        return [
            Transistor(f"{t.name}_dummy{k}", inner, t.bulk, t.bulk, t.bulk, t.role, self.finger_um, t.l)
            for k, inner in enumerate(outer)
        ]

    @property
    def junctions_um(self) -> tuple[float, float, float, float]:
        """Areas (um2) of source and drain and their perimeters (um) as they are drawn, without the gates' edges."""
        w, end = self.finger_um, GATE_SPACE if self.dummies else DIFFUSION_END
        share = 0.5 if self.dummies else 1.0  # a dummy has the other half
        if self.fingers == 1:
            area, edge = share * end * w, share * 2 * end + (0 if self.dummies else w)
            return area, area, edge, edge
        inner, drains = self.fingers // 2 - 1, self.fingers // 2
        source = w * (inner * GATE_SPACE + 2 * share * end)
        around = inner * 2 * GATE_SPACE + 2 * (share * 2 * end + (0 if self.dummies else w))
        return source, w * drains * GATE_SPACE, around, drains * 2 * GATE_SPACE


def draw_device(
    canvas: Canvas,
    masks: AnalogMasks,
    device: Device,
    x: float,
    rail_y: float,
    upright: bool = True,
    room: tuple[float, float] | None = None,
) -> list[Strap]:
    """Draw ``device``, the west end of its diffusion at ``x``; returns its straps: gate, drain, source.

    room: x of the neighbours' rooms, up to which the implant goes: between two of them there is no slit.
    """
    room = room or (x - IMPLANT, x + device.width_um + IMPLANT)
    return _Drawn(canvas, masks, device, x, rail_y, 1 if upright else -1, room).draw()


@dataclass
class _Drawn:
    canvas: Canvas
    masks: AnalogMasks
    device: Device
    x: float
    rail_y: float
    way: int
    room: tuple[float, float]

    def y(self, above_rail: float) -> float:
        return self.rail_y + self.way * above_rail

    def box(self, mask: tuple[int, int], left: float, low: float, right: float, high: float) -> None:
        """A rectangle whose y are above the rail."""
        a, b = self.y(low), self.y(high)
        self.canvas.box(mask, left, min(a, b), right, max(a, b))

    def draw(self) -> list[Strap]:
        d, t, base = self.device, self.device.transistor, self.masks.base
        low, high = RAIL, RAIL + d.finger_um
        self.box(base.active, self.x, low, self.x + d.width_um, high)
        implant = base.nplus if t.role.startswith("n") else base.pplus
        self.box(implant, self.room[0], low - IMPLANT, self.room[1], high + IMPLANT)
        gates = d.fingers + 2 * d.dummies
        starts = [self.x + DIFFUSION_END + k * d.pitch_um for k in range(gates)]
        if t.role in self.masks.low:
            edges = starts[0] - LOW_AROUND, starts[-1] + t.l + LOW_AROUND
            self.box(self.masks.low_threshold, edges[0], low - LOW_AROUND, edges[1], high + LOW_AROUND)
        active_gates = starts[1:-1] if d.dummies else starts
        bar = high + GATE_BAR
        for start in starts:
            top = bar if start in active_gates else high + POLY_END
            bottom = low - POLY_END if start in active_gates else low - SOURCE - BAR_HALF
            self.box(base.poly, start, bottom, start + t.l, top)
        straps = [self._gates(active_gates, bar)]
        stripes = [self.x + DIFFUSION_END - GATE_SPACE / 2 + k * d.pitch_um for k in range(gates + 1)]
        if d.dummies:
            self._dummy(stripes[0], starts[0])
            self._dummy(stripes[-1], starts[-1])
            stripes = stripes[1:-1]
        sources, drains = stripes[0::2], stripes[1::2]
        if d.fingers == 1 and d.swapped:
            sources, drains = drains, sources
        for stripe in sources:
            self._stripe(stripe, low - SOURCE - CONTACT_UM / 2)
        for stripe in drains:
            self._stripe(stripe, low - 0.02)
        straps.append(self._strap(t.drain, drains, low + d.finger_um / 2))
        source = self._strap(t.source, sources, low - SOURCE)
        if t.source == t.bulk:
            self.box(base.metals[1].gds, source.left, 0, source.right, low - SOURCE)
        source = source._replace(fixed=d.dummies, railed=t.source == t.bulk)
        return [strap._replace(end=end) for strap, end in zip((*straps, source), "gds", strict=True)]

    def _stripe(self, x: float, bottom: float) -> None:
        """A column of contacts, under the lowest metal from ``bottom`` to the end of the finger."""
        base, w = self.masks.base, self.device.finger_um
        count = int((w - 2 * CONTACT_IN - CONTACT_UM) / CONTACT_PITCH + 1e-9) + 1
        first = RAIL + w / 2 - (count - 1) * CONTACT_PITCH / 2
        for k in range(count):
            self.canvas.square(base.contact, x, self.y(first + k * CONTACT_PITCH), CONTACT_UM)
        self.box(base.metals[0].gds, x - CONTACT_UM / 2, bottom, x + CONTACT_UM / 2, RAIL + w + 0.02)

    def _strap(self, net: str, stripes: list[float], at: float) -> Strap:
        """Join stripes on the first metal."""
        half = STRAP / 2
        y = self.y(at)
        for x in stripes:
            self.canvas.square(self.masks.base.vias[0].gds, x, y, CONTACT_UM)
        strap = Strap(net, stripes[0] - half, stripes[-1] + half, y)
        self.canvas.wire(1, strap.left, y - half, strap.right, y + half)
        return strap

    def _gates(self, starts: list[float], bar: float) -> Strap:
        """Return the bar of poly, its contacts in the nitride's opening, its strap."""
        base, length, y = self.masks.base, self.device.transistor.l, self.y(bar)
        middles = [start + length / 2 for start in starts]
        left, right = middles[0], middles[-1]
        half = CONTACT_UM / 2
        ends = min(left - PAD, starts[0]), max(right + PAD, starts[-1] + length)
        self.canvas.box(base.poly, ends[0], y - BAR_HALF, ends[1], y + BAR_HALF)
        for x in middles:
            self.canvas.square(base.contact, x, y, CONTACT_UM)
        around = half + NITRIDE
        self.canvas.box(base.contact_poly, left - around, y - around, right + around, y + around)
        self.canvas.wire(0, left - PAD, y - half, right + PAD, y + half)
        return self._strap(self.device.transistor.gate, middles, bar)

    def _dummy(self, stripe: float, start: float) -> None:
        """A dummy: its outer diffusion up to the rail, and its gate, contacted under the end of that."""
        base, end = self.masks.base, start + self.device.transistor.l
        at = RAIL - SOURCE
        y = self.y(at)
        self._stripe(stripe, at - PAD)
        self.canvas.box(base.poly, min(stripe - PAD, start), y - BAR_HALF, max(stripe + PAD, end), y + BAR_HALF)
        self.canvas.square(base.contact, stripe, y, CONTACT_UM)
        self.canvas.square(base.contact_poly, stripe, y, CONTACT_UM + 2 * NITRIDE)
        self.canvas.square(base.vias[0].gds, stripe, y, CONTACT_UM)
        self.box(base.metals[1].gds, stripe - STRAP / 2, 0, stripe + STRAP / 2, at + STRAP / 2)


def swapped(device: Device) -> Device:
    """Return the device with the drain of its single finger in the west: its mirror image."""
    return replace(device, swapped=not device.swapped)
