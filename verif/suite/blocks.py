"""Which block a test counts for, and which level it runs."""

from talbot.rtl.tops import TEST_CHIP_1, TOPS

DIVIDERS = {
    "radix2": "QuadDividerRadix2",
    "radix4": "QuadDividerRadix4",
    "pipelined": "QuadDividerPipelined",
    "cordic": "Cordic",
}
DECODER, HOST, MODELS, FLOW = "Decoder", "Host", "Models", "Flow"
BLOCKS = (*TOPS, *TEST_CHIP_1, DECODER, HOST, MODELS, FLOW)

# The first prefix that matches a test file's folder decides
FOLDERS = (
    ("rtl/amp_ctrl", ("AmpCtrl",)),
    ("rtl/readout_seq", ("ReadoutSeq",)),
    ("rtl/edge_adc", ("EdgeAdc",)),
    ("rtl/adc_bank", ("AdcBank",)),
    ("rtl/quad_divider", tuple(DIVIDERS.values())),
    ("imaging/simulate/divider", tuple(DIVIDERS.values())),
    ("rtl/phase_path", ("PhasePath",)),
    ("rtl/run_length", ("RunLength",)),
    ("rtl/reg_file", ("RegFile",)),
    ("rtl/asp_chip", ("AspChip",)),
    ("rtl/proc", ("Proc",)),
    ("rtl/test_chip_1", ("TestChip1",)),
    ("verif/test_chip_1", ("TestChip1",)),
    ("imaging/simulate", ("AspChip",)),
    ("verif/faults", ("AspChip",)),
    ("models/digital/stream", (DECODER,)),
    ("verif/fuzz/chip", ("AspChip",)),
    ("verif/fuzz", (DECODER,)),
    ("models/parameters", (HOST,)),
    ("rtl/host", (HOST,)),
    ("models", (MODELS,)),
    ("pixels", (MODELS,)),
    ("", (FLOW,)),
)

# The first word that a test's class contains decides; a class is named after the level that it runs
LEVELS = (("Icarus", "Icarus"), ("Verilog", "Verilator"), ("RTL", "RTL"), ("CL", "CL"), ("FL", "FL"))


def blocks_of(folder: str, test: str = "") -> tuple[str, ...]:
    """Return the blocks that a test in ``folder`` counts for; a divider's test counts for the variants it names."""
    blocks = next(
        blocks for prefix, blocks in FOLDERS if not prefix or folder == prefix or folder.startswith(prefix + "/")
    )
    if len(blocks) > 1:
        named = tuple(block for variant, block in DIVIDERS.items() if variant in test.lower())
        return named or blocks
    return blocks


def level_of(test: str) -> str:
    """Return the level of a test by its class ('...::TestVerilog::test_x'): a name of LEVELS, or ''.

    What imaging/simulate and verif/faults run is Verilog in Verilator, or in Icarus where the test's name says so.
    """
    parts = test.split("::")
    for word, level in LEVELS if len(parts) > 2 else ():
        if word in parts[1]:
            return level
    if parts[0].removeprefix("talbot/").startswith(("imaging/simulate", "verif/faults", "imaging/simulate/divider")):
        return "Icarus" if "icarus" in parts[-1].lower() else "Verilator"
    return ""
