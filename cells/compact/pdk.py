"""The drawn cells as a library of PDKMaster (c4m-pdk-sky130), for its exporters."""

from collections.abc import Mapping
from typing import Any

from pdkmaster.design import cell as pdk_cell
from pdkmaster.design.library import RoutingGaugeLibrary
from pdkmaster.design.routinggauge import RoutingGauge
from pdkmaster.technology import geometry

from talbot.cells.compact.canvas import Canvas
from talbot.cells.compact.draw import Drawn, Shape
from talbot.cells.compact.transistors import Schematic
from talbot.platforms.patience import imported

PDK: Any = imported("c4m.pdk.sky130.pdkmaster")  # draws cells; its types do not tell metals from other primitives
PRIMITIVES = PDK.tech.primitives


class DrawnCell(pdk_cell.Cell):
    """A cell with its circuit and layout."""

    def __init__(self, canvas: Canvas, schematic: Schematic, drawing: Drawn) -> None:
        super().__init__(name=schematic.name, tech=PDK.tech, cktfab=PDK.cktfab, layoutfab=PDK.layoutfab)
        self.schematic, self.drawing = schematic, drawing
        circuit = self.new_circuit()
        ports, pins = schematic.ports, self._devices(circuit, canvas)
        for net in (*ports, *sorted(pins.keys() - set(ports))):
            circuit.new_net(name=net, external=net in ports, childports=tuple(pins.get(net, ())))
        layout = self.new_circuitlayouter().layout
        for s in (Shape(*shape) for shape in drawing["shapes"]):
            box = geometry.Rect(left=s.left, bottom=s.bottom, right=s.right, top=s.top)
            layout.add_shape(layer=PRIMITIVES[s.layer], net=circuit.nets[s.net] if s.net else None, shape=box)
        layout.boundary = geometry.Rect(left=0.0, bottom=0.0, right=drawing["width"], top=canvas.height)

    def _devices(self, circuit: Any, canvas: Canvas) -> dict[str, list[Any]]:
        """Add the instances; returns the ports that are connected to each net."""
        pins: dict[str, list[Any]] = {}
        s = self.schematic
        for kind, switches, (low, high), bulk in (("n", s.n, canvas.n, "vss"), ("p", s.p, canvas.p, "vdd")):
            model, width = PRIMITIVES[s.models[kind]], round(high - low, 3)
            for k, switch in enumerate(switches):
                device = circuit.instantiate(model, name=f"{kind}{k}", w=width, l=canvas.length)
                nets = {"sourcedrain1": switch.a, "gate": switch.gate, "sourcedrain2": switch.b, "bulk": bulk}
                for port, net in nets.items():
                    pins.setdefault(net, []).append(device.ports[port])
        if "diode" in self.drawing:
            width, height = self.drawing["diode"]
            device = circuit.instantiate(PRIMITIVES["ndiode"], name="d0", width=width, height=height)
            pins.setdefault("i", []).append(device.ports["cathode"])
            pins.setdefault("vss", []).append(device.ports["anode"])
        return pins


def to_pdkmaster(name: str, canvas: Canvas, drawn: Mapping[str, tuple[Schematic, Drawn]]) -> RoutingGaugeLibrary:
    """The library ``name`` of the cells ``drawn``."""
    low, high, pitches = PRIMITIVES["m1"], PRIMITIVES["m5"], {PRIMITIVES[metal]: canvas.site for metal in ("m1", "m2")}
    sizes = {"pingrid_pitch": canvas.site, "row_height": canvas.height, "pitches": pitches}
    gauge = RoutingGauge(tech=PDK.tech, bottom=low, bottom_direction="horizontal", top=high, **sizes)
    library = RoutingGaugeLibrary(name=name, tech=PDK.tech, routinggauge=gauge)
    for schematic, drawing in drawn.values():
        library.cells += DrawnCell(canvas, schematic, drawing)
    return library
