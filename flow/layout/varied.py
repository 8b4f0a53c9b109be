"""What of a sensor a layout can vary: nothing yet. Designs have fixed sizes, analog blocks are drawn for one pitch."""

from talbot.base.sensor import Varied
from talbot.pixels.drawn import DRAWN_PITCH

SIZES = "tile", "array.rows", "array.cols", "chip"
VARIED = Varied(fixed=dict.fromkeys(SIZES, "designs are laid out in the sizes of the standard sensor") | DRAWN_PITCH)
