"""AdcBank: the converter lanes of a row and their control."""

from talbot.rtl.adc_bank.adc_bank_cl import AdcBankCL
from talbot.rtl.adc_bank.adc_bank_fl import AdcBankFL
from talbot.rtl.adc_bank.adc_bank_rtl import AdcBank

__all__ = ["AdcBank", "AdcBankCL", "AdcBankFL"]
