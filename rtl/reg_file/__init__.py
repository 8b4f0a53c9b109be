"""RegFile: the register file, reached over SPI."""

from talbot.rtl.reg_file.config import chip_config, chip_state, chip_status
from talbot.rtl.reg_file.reg_file_fl import RegFileFL
from talbot.rtl.reg_file.reg_file_rtl import RegFile
from talbot.rtl.reg_file.synchronizer_rtl import Synchronizer

__all__ = ["RegFile", "RegFileFL", "Synchronizer", "chip_config", "chip_state", "chip_status"]
