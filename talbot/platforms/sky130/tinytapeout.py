"""Tiny Tapeout's tiles on SKY130: their sizes and ports, and the configuration that projects must not change.

From tt-support-tools (tile_sizes.yaml; rows and pins of def/tt_block_1x1_pg.def, whose pins have the same places along
the edge for every number of tiles; precheck/pin_check.py) and src/config.json of its template.
"""

from talbot.platforms.frame import Frame
from talbot.platforms.sky130 import layers

SIZES_UM = {"1x1": (161.00, 111.52), "1x2": (161.00, 225.76), "2x2": (334.88, 225.76), "4x4": (682.64, 511.36)}
BYTES = "ui_in", "uio_in", "uo_out", "uio_out", "uio_oe"
PORTS = "ena", "clk", "rst_n", *(f"{name}[{bit}]" for name in BYTES for bit in range(8))  # from the east on
FIRST_UM, PITCH_UM = 146.74, 2.76
PORT_UM = 0.30, 1.00
CORE_MARGIN_UM = 2.0, 2.0  # straps, on the core alone, must end at most 10 um from the edges
FRAME = "tt_"  # before the number of tiles: the name of a frame
FRAMES = {
    f"{FRAME}{tiles}": Frame(
        *size,
        margin_um=CORE_MARGIN_UM,
        ports=tuple((name, round(FIRST_UM - k * PITCH_UM, 2)) for k, name in enumerate(PORTS)),
        port_um=PORT_UM,
        layer=layers.MET4.lef,
        supplies=("VPWR", "VGND"),
    )
    for tiles, size in SIZES_UM.items()
}
# An analog project of 1x2 tiles with 3.3 V: def/analog/tt_analog_1x2_3v3.def, whose digital ports are in the same order
ANALOG_UM, ANALOG_FIRST_UM = (145.36, 225.76), 131.10
ANALOG_PORTS = tuple((name, round(ANALOG_FIRST_UM - k * PITCH_UM, 2)) for k, name in enumerate(PORTS))
ANALOG_PINS = tuple((f"ua[{k}]", round(136.62 - 19.32 * k, 2)) for k in range(8))  # at the south edge
ANALOG_PIN_UM = 0.90, 1.00
FULL = 0.60  # cells' area by core area for which the default density is meant

CONFIG = {
    "PL_TARGET_DENSITY_PCT": round(100 * FULL),
    "PL_RESIZER_HOLD_SLACK_MARGIN": 0.1,
    "GRT_RESIZER_HOLD_SLACK_MARGIN": 0.05,
    "RUN_LINTER": True,
    "LINTER_INCLUDE_PDK_MODELS": True,
    "RUN_KLAYOUT_XOR": False,
    "RUN_KLAYOUT_DRC": False,
    "DESIGN_REPAIR_BUFFER_OUTPUT_PORTS": False,
    "TOP_MARGIN_MULT": 1,
    "BOTTOM_MARGIN_MULT": 1,
    "LEFT_MARGIN_MULT": 6,
    "RIGHT_MARGIN_MULT": 6,
    "FP_SIZING": "absolute",
    "GRT_ALLOW_CONGESTION": True,
    "FP_IO_HLENGTH": 2,
    "FP_IO_VLENGTH": 2,
    "FP_PDN_VPITCH": 38.87,
    "RUN_CTS": True,
    "FP_PDN_MULTILAYER": False,
    "RT_MAX_LAYER": "met4",
    "MAGIC_DEF_LABELS": False,
    "MAGIC_WRITE_LEF_PINONLY": True,
}
