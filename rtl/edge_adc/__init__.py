"""EdgeAdc: control of one successive-approximation lane."""

from talbot.rtl.edge_adc.edge_adc_cl import EdgeAdcCL
from talbot.rtl.edge_adc.edge_adc_fl import EdgeAdcFL
from talbot.rtl.edge_adc.edge_adc_rtl import EdgeAdc

__all__ = ["EdgeAdc", "EdgeAdcCL", "EdgeAdcFL"]
