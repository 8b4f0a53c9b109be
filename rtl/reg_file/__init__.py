"""RegFile: the register file, reached over SPI."""

from .config import chip_config, chip_state, chip_status
from .reg_file_fl import RegFileFL
from .reg_file_rtl import RegFile
from .synchronizer_rtl import Synchronizer

__all__ = ["RegFile", "RegFileFL", "Synchronizer", "chip_config", "chip_state", "chip_status"]
