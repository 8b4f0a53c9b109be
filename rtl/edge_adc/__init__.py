"""EdgeAdc: control of one successive-approximation lane."""

from .edge_adc_cl import EdgeAdcCL
from .edge_adc_fl import EdgeAdcFL
from .edge_adc_rtl import EdgeAdc

__all__ = ["EdgeAdc", "EdgeAdcCL", "EdgeAdcFL"]
