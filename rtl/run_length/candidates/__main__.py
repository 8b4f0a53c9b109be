"""`python -m rtl.run_length.candidates`: Verilog of the packers, the chosen one too, by rtl.export and its options."""

import sys

from rtl import export
from rtl.run_length.packer_rtl import PayloadPacker

from . import AdaptiveRicePacker, BytePairPacker, FixedRicePacker, NibblePacker

PACKERS = BytePairPacker, NibblePacker, FixedRicePacker, AdaptiveRicePacker, PayloadPacker

if __name__ == "__main__":
    export.TOPS.clear()
    export.TOPS.update({packer.__name__: lambda sensor, packer=packer: packer() for packer in PACKERS})
    sys.exit(export.main())
