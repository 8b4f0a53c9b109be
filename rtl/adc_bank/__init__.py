"""AdcBank: the converter lanes of a row and what drives them."""

from .adc_bank_cl import AdcBankCL
from .adc_bank_fl import AdcBankFL
from .adc_bank_rtl import AdcBank

__all__ = ["AdcBank", "AdcBankCL", "AdcBankFL"]
