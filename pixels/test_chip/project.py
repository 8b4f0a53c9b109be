"""The files of the shuttle's project: LEF of the pins, a Verilog stub, info.yaml and its page."""

import json

from talbot.base.lef import write as lef_text
from talbot.pixels.test_chip.circuit import BIAS, GROUND, HIGH, INPUTS, LOGIC, NAME, OUT_A, OUT_B, VDDA
from talbot.pixels.test_chip.draw import HEIGHT, STRIPE, STRIPE_ENDS, STRIPES, TIED, WIDTH
from talbot.pixels.test_chip.places import COLS, ROWS
from talbot.platforms.sky130.tinytapeout import ANALOG_PIN_UM, ANALOG_PINS, ANALOG_PORTS, PORT_UM

METAL = "met4"
DESCRIPTIONS = {
    VDDA: "supply of the pixels, 1.8 to 2.2 V",
    OUT_B: "diode b of the selected pixel",
    OUT_A: "diode a of the selected pixel",
    BIAS: "current in, 5 uA",
}
DIRECTIONS = {"ui_in": "input", "uio_in": "input", "uo_out": "output", "uio_out": "output", "uio_oe": "output"}


def lef() -> str:
    """Return the LEF: outline, pins, nothing else, as the shuttle's tools write it."""
    pins = []
    for name, x in ANALOG_PORTS:
        direction = DIRECTIONS.get(name.partition("[")[0], "input").upper()
        box = x - PORT_UM[0] / 2, HEIGHT - PORT_UM[1], x + PORT_UM[0] / 2, HEIGHT
        pins.append(_pin(name, direction, "SIGNAL", box))
    for name, x in ANALOG_PINS:
        box = x - ANALOG_PIN_UM[0] / 2, 0.0, x + ANALOG_PIN_UM[0] / 2, ANALOG_PIN_UM[1]
        pins.append(_pin(name, "INOUT", "SIGNAL", box))
    for name, x in STRIPES.items():
        box = x - STRIPE / 2, STRIPE_ENDS[0], x + STRIPE / 2, STRIPE_ENDS[1]
        pins.append(_pin(name, "INOUT", "GROUND" if name == GROUND else "POWER", box))
    statements = ["CLASS BLOCK", f"FOREIGN {NAME}", "ORIGIN 0.000 0.000", lef_text.size(WIDTH, HEIGHT)]
    return lef_text.HEADER + lef_text.macro(NAME, statements, pins) + lef_text.END


def _pin(name: str, direction: str, use: str, box: tuple[float, float, float, float]) -> lef_text.Pin:
    return lef_text.Pin(name, [f"DIRECTION {direction}", f"USE {use}"], [lef_text.Rectangles(METAL, [box])])


def stub() -> str:
    """Return the Verilog module, a black box: outputs are tied to ground in the layout."""
    ports = [f"inout wire {name}" for name in STRIPES]
    ports += [f"{direction} wire [7:0] {name}" for name, direction in DIRECTIONS.items()]
    ports += ["inout wire [7:0] ua", *(f"input wire {name}" for name in ("ena", "clk", "rst_n"))]
    outputs = sorted({name.partition("[")[0] for name in TIED})
    text = ",\n".join(f"    {port}" for port in ports)
    ties = "\n".join(f"    assign {name} = 8'b0;" for name in outputs)
    return f"`default_nettype none\n\nmodule {NAME} (\n{text}\n);\n{ties}\nendmodule\n"


def info() -> str:
    """Text of info.yaml, version 6; a JSON string is a YAML string."""
    pins = {pin: "" for bank in ("ui", "uo", "uio") for pin in (f"{bank}[{bit}]" for bit in range(8))}
    pins |= {pin.replace("_in", ""): line for pin, line in INPUTS.items()}
    pins |= {f"ua[{bit}]": DESCRIPTIONS.get(f"ua[{bit}]", "") for bit in range(6)}
    text = "\n".join(f"  {pin}: {json.dumps(name)}" for pin, name in pins.items())
    return f"""project:
  title: "Angle-sensitive pixels"
  author: "Talbot"
  description: "Pixels of 24 types with two diodes each, plain and covered ones, read out through the pins"
  language: "Analog"
  clock_hz: 0
  tiles: "1x2"
  analog_pins: {len(DESCRIPTIONS)}
  uses_3v3: true
  top_module: "{NAME}"
  source_files:
    - "{NAME}.v"

pinout:
{text}

yaml_version: 6
"""


def page() -> str:
    """Return the page docs/info.md of the shuttle's datasheet."""
    return f"""## How it works

{ROWS} rows of {COLS} pixels of 10 um, each with two photodiodes and three transistors a diode. Rows 0 to 3 are a tile
of 24 types of angle-sensitive pixels; row 4 has pixels without gratings, plain in columns 0, 2 and 4, covered with
metal in the others. `pixel_reset` resets all pixels, `read[r]` connects a row to the columns, `column[c]` a column to
both followers. The pixels' supply is {VDDA}; {LOGIC} is the level of the inputs, {HIGH} of all gates.

## How to test

Light falls on the bare die. Apply 2.0 V to {VDDA} and 5 uA into {BIAS}. Set `pixel_reset`, one `read` and one `column`:
{OUT_A} and {OUT_B} have the reset level. Clear `pixel_reset`: both fall with the light.

## External hardware

A supply, a source of 5 uA, a voltmeter of high resistance; a lamp behind a narrow-band filter and a rotation stage.
"""
