"""The comparator: the strong-arm latch symmetric about an axis, the latch that holds its decision above it.

    holding     hold_n  hold_n  buffer_n | buffer_p  hold  hold
    strong arm  switch  inp  latch_np  tail  latch_nn  inn  switch

The pair and the n latch have dummies at their ends. In a lane the switches of the common plates are the outermost.
"""

from collections.abc import Mapping, Sequence

from talbot.pixels.analog_layout import flat
from talbot.pixels.analog_layout.device import Device, swapped
from talbot.pixels.analog_layout.strip import Strip, draw_strip, trunk
from talbot.pixels.analog_layout.strip_plan import Placed, Plan, mirrored
from talbot.pixels.circuits.netlist import Circuit
from talbot.pixels.layout.canvas import Canvas
from talbot.platforms.analog import AnalogMasks

WITH_DUMMIES = "inp", "inn", "latch_np", "latch_nn"
ROOM = 0.6  # um next to each device, for its drops
HOLD_ROOM = 1.2  # the same in the latch that holds the decision
BETWEEN_STRIPS = 1.5  # middles of rails, um
CROSSING = 3.0  # of what joins the strips from the axis, um

Pair = tuple[Device, Device]


def devices(circuit: Circuit) -> dict[str, Device]:
    """All transistors of a circuit by name, in fingers."""
    by_name = {}
    for t in flat.transistors(circuit):
        last = t.name.rsplit(".", 1)[-1]
        by_name[t.name] = Device(t, 2) if last == "tail" else Device.of(t, dummies=last in WITH_DUMMIES)
    return by_name


def pair(d: Mapping[str, Device], west: str, east: str) -> Pair:
    """Two devices that are mirror images."""
    return (d[west], d[east]) if d[west].fingers > 1 else (d[west], swapped(d[east]))


def comparator_plans(
    d: Mapping[str, Device],
    axis: float,
    ends: tuple[float, float],
    prefix: str = "",
    outer: Sequence[Pair] = (),
    outer_p: Sequence[Pair] = (),
    reach: Mapping[str, Sequence[float]] | None = None,
) -> tuple[Plan, Plan]:
    """Plans of the strips of the comparator whose transistors ``d`` are named from ``prefix`` on.

    ends: of the strips. outer, outer_p: further pairs outside of it. reach: see `Plan.through`.
    """

    def named(*names: str) -> list[Pair]:
        return [pair(d, *(prefix + name for name in names[k : k + 2])) for k in range(0, len(names), 2)]

    arm = f"{prefix}arm."
    inp, inn, latch_p, latch_n = (d[arm + name].transistor for name in ("inp", "inn", "latch_nn", "latch_np"))
    n = mirrored(d[f"{arm}tail"], [*named("arm.latch_np", "arm.latch_nn", "arm.inp", "arm.inn"), *outer], axis, ROOM)
    p = mirrored(
        None,
        [
            *named("arm.latch_pp", "arm.latch_pn", "arm.reset_outn", "arm.reset_outp", "arm.reset_xp", "arm.reset_xn"),
            *outer_p,
        ],
        axis,
        ROOM,
    )
    outputs = latch_n.drain, latch_p.drain
    split = (inp.gate, inn.gate), (inp.drain, inn.drain)
    sides = {net: (axis + way * CROSSING,) for net, way in zip(outputs, (-1, 1), strict=True)}
    reach = reach or {}

    def through(placed: Sequence[Placed]) -> dict[str, Sequence[float]]:
        present = {net for device in placed for net in device.device.transistor.nodes}
        return {net: x for net, x in (*reach.items(), *sides.items()) if net in present}

    arm_plan = Plan(n, p, *ends, through((*n, *p)), split, (outputs,), axis)
    rows = []
    for kind in ("n", "p"):
        kinds = [f"{side}.{kind}{leg}" for leg in ("a", "b") for side in ("hold_n", "hold")]
        rows.append(mirrored(None, named(f"buffer_n.{kind}", f"buffer_p.{kind}", *kinds), axis, HOLD_ROOM))
    held, inverse = (d[f"{prefix}{side}.na"].transistor.drain for side in ("hold", "hold_n"))
    settled = tuple(d[f"{prefix}{side}.n"].transistor.drain for side in ("buffer_n", "buffer_p"))
    split = outputs, (settled[0], settled[1])
    hold = through((*rows[0], *rows[1]))
    return arm_plan, Plan(rows[0], rows[1], *ends, hold, split, ((inverse, held),), axis)


def draw_comparator(canvas: Canvas, masks: AnalogMasks, plans: tuple[Plan, Plan], y: float) -> list[Strip]:
    """Draw both strips, the lowest rail at ``y``, and join them."""
    arm, hold = plans
    lower = draw_strip(canvas, masks, arm, y)
    upper = draw_strip(canvas, masks, hold, y + arm.height_um + BETWEEN_STRIPS)
    for net, way in zip(arm.twisted[0], (-1, 1), strict=True):
        trunk(canvas, (*lower.tracks, *upper.tracks), net, (arm.axis or 0.0) + way * CROSSING)
    return [lower, upper]


def least_half(plans: tuple[Plan, Plan]) -> float:
    """Half the length that the strips must have, um."""
    return max(placed.high - (plan.axis or 0.0) for plan in plans for placed in plan.placed())
