"""A small die: 16 x 120 pixels, two lanes, and a core that has the chip's pins and straps and nothing in it."""

import itertools
import json
import shutil

from talbot.flow.layout.sensor.pads import width_um
from talbot.flow.layout.sensor.plan import BLOCKS, CORE, SIGNALS, DieParameters
from talbot.flow.layout.sensor.ring import TOP
from talbot.flow.layout.sensor.routing import STUB
from talbot.flow.layout.sensor.steps.die_connectivity import DieConnectivity
from talbot.flow.layout.sensor.steps.die_gds import DieGds, DieGdsParameters
from talbot.flow.layout.sensor.steps.die_plan import DiePlan, DiePlanParameters
from talbot.flow.layout.steps.parameters import PdkParameters
from talbot.models.parameters import ArrayParameters, ChipParameters
from talbot.pixels.blocks import AnalogSizes, blocks
from talbot.pixels.footprints import write
from talbot.platforms.die import top_metal
from talbot.platforms.layout import layout_platform
from talbot.platforms.pads import pad_process
from talbot.platforms.pixel import pixel_process
from talbot.platforms.sky130.chipignite import BARE, BIASES, CARAVAN, GPIO

DIE = DieParameters(2800.0, 1800.0, pad_um=91.0, side_um=91.0, west=2, east=2)
RULES = {
    "metals": {
        name: {"width": least, "space": least, "area": area}
        for name, least, area in (
            ("li", 0.17, 0.0),
            ("m1", 0.14, 0.083),
            ("m2", 0.14, 0.0676),
            ("m3", 0.3, 0.24),
            ("m4", 0.3, 0.24),
        )
    },
    "vias": {
        "mcon": {"below": [0.0, 0.0], "above": [0.03, 0.06]},
        "via": {"below": [0.055, 0.085], "above": [0.055, 0.085]},
        "via2": {"below": [0.04, 0.085], "above": [0.065, 0.065]},
        "via3": {"below": [0.06, 0.09], "above": [0.065, 0.065]},
    },
}
CORE_INPUTS = {"clk", "reset", "sclk", "csn", "mosi", "link_rdy"}
WIDTH, HEIGHT = 200.0, 400.0
SPLIT = 6  # the place of the pin whose metal is in pieces, each of them too small for a stub


SIZES = AnalogSizes(row_driver_um=60.0, columns_um=100.0, lane_um=100.0, lanes_um=300.0, chip_um=360.0)
ANALOG = blocks(ArrayParameters(16, 120), ChipParameters(2), SIZES)


def core_pins(analog=ANALOG):
    """dict pin -> direction: the die's signals and what the analog blocks have in the south, the other way round."""
    outer = {
        pin.name: "output" if pin.direction == "input" else "input"
        for block in analog
        for pin in block.pins
        if pin.side == "south" and not pin.name.startswith(("column_", "lane_"))
    }
    own = {name: "input" if name in CORE_INPUTS else "output" for name in SIGNALS}
    return dict(sorted((outer | own).items()))


def core(folder, analog=ANALOG):
    """Write core.lef and core.gds: pins on the west and the east, in turn, and four straps."""
    import klayout.db as db

    layout = db.Layout()
    cell = layout.create_cell("Core")
    lines = ["MACRO Core", f"  SIZE {WIDTH} BY {HEIGHT} ;"]

    def draw(name, layer, lef, direction, boxes):
        lines.extend([f"  PIN {name}", f"    DIRECTION {direction.upper()} ;", "    PORT", f"      LAYER {lef} ;"])
        for box in boxes:
            lines.append(f"      RECT {' '.join(f'{size:.3f}' for size in box)} ;")
            cell.shapes(layout.layer(layer, 20)).insert(db.DBox(*box))
            cell.shapes(layout.layer(layer, 16)).insert(db.DText(name, db.DTrans(db.DBox(*box).center() - db.DPoint())))
        lines.extend(["    END", f"  END {name}"])

    metal = layout_platform("sky130").metals[STUB]
    for k, (name, direction) in enumerate(core_pins(analog).items()):
        left, bottom = (0.0 if k % 2 == 0 else WIDTH - 0.3), 5 + 4.0 * (k // 2)
        ends = (0.0, 0.13, 0.32) if k == SPLIT else (0.0, 0.32)
        pieces = [(left, bottom + low, left + 0.3, bottom + high) for low, high in itertools.pairwise(ends)]
        draw(name, metal.layer, metal.lef, direction, pieces)
    for net, xs in (("vss", (50.0, 110.0)), ("vdd", (80.0, 140.0))):
        draw(net, 71, "met4", "inout", [(x - 0.6, 0.0, x + 0.6, HEIGHT) for x in xs])
    (folder / "core.lef").write_text("\n".join([*lines, "END Core", "END LIBRARY", ""]))
    layout.write(str(folder / "core.gds"))


# um: of the two metals below the bond pads' and of these, from what is outside; the ground's innermost is before iovdd
TRACKS = {
    "iovss": [(4, 2, 20), (4, 142.6, 151.4), (5, 144, 150)],
    "iovdd": [(4, 90, 133), (5, 92, 131)],
    "vdd": [(4, 157, 171)],
    "vss": [(4, 173, 186)],
}
BOND = 4.5, 24.0, 85.5, 86.0
CORE_PINS = {"IOPadIn": ("p2c", 44.85), "IOPadOut": ("c2p", 44.85), "IOPadAnalog": ("padres", 60.6)}


def pads(folder):
    """Write pads.gds and pins.json: cells of the ring with their tracks, bond pads and pins, and no transistor."""
    import klayout.db as db

    process, metals, vias = pad_process("sky130"), pixel_process("sky130").metals, pixel_process("sky130").vias
    layout, found = db.Layout(), {}
    for name in process.cells:
        cell, own = layout.create_cell(name), found.setdefault(name, {})

        def metal(level, *box, cell=cell):
            cell.shapes(layout.layer(*metals[level].gds)).insert(db.DBox(*box))

        def cut(level, x, y, size, cell=cell):
            box = db.DBox(x - size / 2, y - size / 2, x + size / 2, y + size / 2)
            cell.shapes(layout.layer(*vias[level].gds)).insert(box)

        def draw(level, pin, *box, cell=cell, own=own, metal=metal):
            shape = db.DBox(*box)
            metal(level, *box)
            cell.shapes(layout.layer(*metals[level].pin)).insert(db.DText(pin, db.DTrans(shape.center() - db.DPoint())))
            own.setdefault(pin, []).append([level, *(round(1000 * size) for size in box)])

        left, right = (-188.0, 0.0) if name == process.corner else (0.0, width_um(name, process))
        for pin, pieces in TRACKS.items():
            for level, low, high in pieces:
                draw(level, pin, left + (low if left else 0), low, right, high)
                if left:
                    draw(level, pin, left + low, low, left + high, 188.0)
                elif level == TOP and right > 2:
                    cut(4, right / 2, (low + high) / 2, 0.8)
        if name.startswith("IOPad"):
            pin = next((pin for pin, supply in process.supplies.items() if supply == name), "pad")
            draw(TOP, pin, *BOND)
            if pin in TRACKS:
                middles = [(low + high) / 2 for level, low, high in TRACKS[pin] if level < TOP]
                metal(4, 40, 50, 44, 54)
                cut(4, 42, 52, 0.8)
                metal(3, 41, min(52, *middles) - 0.5, 43, max(52, *middles) + 0.5)
                for at in (52, *middles):
                    cut(3, 42, at, 0.2)
            if name in CORE_PINS:
                pin, x = CORE_PINS[name]
                draw(1, pin, x, 172.0, x + 0.29, 188.0)
    (folder / "pins.json").write_text(json.dumps(found))
    layout.write(str(folder / "pads.gds"))


def files(folder, analog=ANALOG):
    """Everything that the die's steps are given: dict name -> Path."""
    write(folder, analog, "sky130", AnalogSizes().supply_um)
    core(folder, analog)
    pads(folder)
    (folder / "rules.json").write_text(json.dumps(RULES))
    for block in BLOCKS:
        shutil.copyfile(folder / f"{block}.lef", folder / f"{block}.black_box")
    found = {f"{block}.{kind}": folder / f"{block}.{kind}" for block in (*BLOCKS, CORE) for kind in ("lef", "gds")}
    found |= {f"{block}.black_box": folder / f"{block}.black_box" for block in BLOCKS}
    return found | {
        "library.rules": folder / "rules.json",
        "die_pads.gds": folder / "pads.gds",
        "die_pads.pins": folder / "pins.json",
    }


def run(step, given, folder):
    """The step's metrics; its outputs are added to ``given``."""
    outputs = {name: folder / file for name, file in step.outputs.items()}
    metrics = step.run({name: given[source] for name, source in step.inputs.items()}, outputs)
    given |= {f"{step.name}.{name}": path for name, path in outputs.items()}
    return metrics


def plan(given, folder, die=DIE):
    """Metrics of the plan."""
    return run(DiePlan(DiePlanParameters("sky130", die)), given, folder)


def connectivity(given, folder, drawn=()):
    """Metrics of the comparison of the GDS of the plan with its nets."""
    run(DieGds(DieGdsParameters(drawn=drawn)), given, folder)
    return run(DieConnectivity(PdkParameters()), given, folder)


SIDES = {"west": range(14, GPIO), "east": range(14)}


def wrapper(path, width=2800.0, height=1900.0, cell=CARAVAN.cell):
    """Write an empty wrapper with the pins of Caravan, evenly on its sides; met2 in the south, else met3."""
    import klayout.db as db

    metals, layout = layout_platform("sky130").metals, db.Layout()
    top = layout.create_cell(cell)
    top.shapes(layout.layer(*layout_platform("sky130").outline)).insert(db.DBox(0, 0, width, height))

    def pin(name, metal, *box):
        shape = db.DBox(*box)
        for numbers in (metal.gds, metal.pin):
            top.shapes(layout.layer(*numbers)).insert(shape)
        top.shapes(layout.layer(*metal.pin)).insert(db.DText(name, db.DTrans(shape.center() - db.DPoint())))

    rows = {side: [f"io_{kind}[{k}]" for k in ks for kind in ("in", "out", "oeb")] for side, ks in SIDES.items()}
    rows["east"] += [f"gpio_noesd[{k}]" for k in BIASES.values()]
    wide = {side: list(pins.values()) for side, pins in CARAVAN.supplies.items()}
    wide["east"].append("io_analog[0]")
    for side, names in rows.items():
        left, right = (-2.0, 2.4) if side == "west" else (width - 2.4, width + 2.0)
        for k, name in enumerate(names):
            y = 12.0 + 1.0 * round(k * (height - 500.0) / len(names))
            pin(name, metals[3], left, y - 0.28, right, y + 0.28)
        for k, name in enumerate(wide[side]):
            y = height - 470.0 + 100.0 * k
            pin(name, metals[3], *((0.0, y, 8.5, y + 24.0) if side == "west" else (width - 8.5, y, width, y + 24.0)))
    for k, name in enumerate([*(f"io_analog[{k}]" for k in range(1, len(BARE))), "vssa1"]):
        x = 300.0 + 200.0 * k
        clamped = k % 2 and name != "vssa1"  # two pieces, up to the top metal
        for left in (x, x + 40.0) if clamped else (x,):
            for metal in (*metals[3:], top_metal("sky130").metal) if clamped else metals[3:4]:
                pin(name, metal, left, height - 8.5, left + 25.0, height + 4.0)
    for k in range(8):
        pin(f"la_data_out[{k}]", metals[2], 600.0 + 6.0 * k, -2.0, 600.56 + 6.0 * k, 2.4)
    layout.write(str(path))
    return path
