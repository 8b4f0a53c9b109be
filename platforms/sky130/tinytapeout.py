"""Tiny Tapeout's tiles on SKY130: their sizes, and the configuration that projects must not change.

From tt-support-tools (tile_sizes.yaml; the rows of def/tt_block_1x1_pg.def) and src/config.json of its template.
"""

from .cells import SITE

SIZES_UM = {"1x1": (161.00, 111.52), "1x2": (161.00, 225.76), "2x2": (334.88, 225.76)}
MARGIN_SITES, MARGIN_ROWS = 12, 2
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


def core_um2(tiles: str) -> float:
    """Area for cells in so many tiles."""
    width, height = SIZES_UM[tiles]
    columns, rows = round(width / SITE.width_um) - MARGIN_SITES, round(height / SITE.height_um) - MARGIN_ROWS
    return columns * SITE.width_um * rows * SITE.height_um
