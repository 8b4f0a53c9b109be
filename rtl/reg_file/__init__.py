"""RegFile: the register file, reached over SPI."""

from .config import chip_config, chip_status
from .reg_file_fl import RegFileFL
from .reg_file_rtl import RegFile

__all__ = ["RegFile", "RegFileFL", "chip_config", "chip_status"]
