"""SKY130's fifth metal, above what Coriolis routes on."""

from platforms.die import TopMetal

from .layers import MET5, VIA4

TOP = TopMetal(MET5, VIA4)
