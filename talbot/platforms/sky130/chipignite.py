"""ChipFoundry's chipIgnite: the analog user area of Caravan, 2.92 mm x 3.52 mm, and the sensor's pins in it.

The user area has 27 GPIO, 11 pads without a driver (`io_analog`) and two sets of supplies. GPIO 0 to 4 are the
management processor's after power-up; the sensor does not use them. GPIO 7 to 24 have an analog pin, without ESD
resistor as `gpio_noesd`; a GPIO is digital or analog.
"""

from talbot.platforms.wrapper import Wrapper

GPIO = 27
ANALOG_PADS = 14, 11  # first user index behind the analog pads, and their number: GPIO 14 of the user area is pad 25
INPUTS = {"clk": 14, "reset": 15, "sclk": 16, "csn": 17, "mosi": 18, "link_rdy": 9}
OUTPUTS = {"miso": 19, "busy": 20, "frame_sync": 21, **{f"link_data[{k}]": 22 + k for k in range(5)}}
OUTPUTS |= {f"link_data[{5 + k}]": 5 + k for k in range(3)} | {"link_val": 8}
# Biases, which only meet capacitors outside: analog pins of GPIO 10 to 13
BIASES = {"vbl": 3, "vcn": 4, "vcp": 5, "vbp": 6}
# References and the rows' supply, without a resistor
BARE = ("ibias_columns", "level", "start_a", "start", "reference", "dark", "vref", "vcm", "refn", "refp")

# Words of a GPIO's configuration: input without pull, push-pull output, analog with both buffers off
MODES = {"input": "13'h0402", "output": "13'h1808", "analog": "13'h000a"}


def defines() -> str:
    """Text of user_defines.v: the configuration of GPIO 5 to 26 after power-up."""
    lines = ["// Configuration of the GPIO after power-up, by the number of the pad", "`default_nettype none", ""]
    for k in range(5, GPIO):
        pad = k + (ANALOG_PADS[1] if k >= ANALOG_PADS[0] else 0)
        mode = "input" if k in INPUTS.values() else "output" if k in OUTPUTS.values() else "analog"
        lines.append(f"`define USER_CONFIG_GPIO_{pad}_INIT {MODES[mode]}  // user area's GPIO {k}: {mode}")
    return "\n".join([*lines, ""])


CARAVAN = Wrapper(
    name="chipIgnite, Caravan",
    cell="user_analog_project_wrapper",
    signals={net: f"io_in[{k}]" for net, k in INPUTS.items()}
    | {net: f"io_out[{k}]" for net, k in OUTPUTS.items()}
    | {net: f"gpio_noesd[{k}]" for net, k in BIASES.items()}
    | {net: f"io_analog[{k}]" for k, net in enumerate(BARE)},
    spare="la_data_out",
    supplies={
        "west": {"vdd": "vccd2", "vss": "vssd2", "vssa": "vssa2", "vddr": "io_analog[10]"},
        "east": {"vddc": "vccd1", "vdda": "vdda1", "vssa": "vssa1"},
        "north": {"vssa": "vssa1"},
    },
    low=tuple(f"io_out[{k}]" for k in range(GPIO) if k not in OUTPUTS.values())
    + tuple(f"io_oeb[{k}]" for k in OUTPUTS.values()),
    high=tuple(f"io_oeb[{k}]" for k in range(GPIO) if k not in OUTPUTS.values()),
    levels={"west": ("vss", "vdd"), "east": ("vssa", "vddc")},
    outputs=("wbs_ack_o", "wbs_dat_o", "la_data_out", "io_out", "io_oeb", "user_irq"),
    inouts=("gpio_", "io_analog", "io_clamp"),
    power=("vcc", "vdd", "vss"),
    files={"verilog/rtl/user_defines.v": defines()},
)
WRAPPERS = {CARAVAN.cell: CARAVAN}
