"""SKY130's optical stack.

Heights, films, minimum widths and spaces: [Edwards2024], sky130A/metal_stack_sky130A.py, as SkyWater's diagram of the
stack has them (klayout-pex 0.6.12 has the same). All oxides are taken as silica; the nitride below the second oxide
and the one on top are those where no metal is. The polyimide over the chip is left away, as in a window of a pad. The
local interconnect is titanium nitride, of no known index here, and not offered for gratings.

"met2-2.301" is a second table in circulation: met2 and all above 0.295 um higher. Where it comes from was not found.
"""

from talbot.platforms.optics import Film, Metal, OpticalStack

# name, height of its lower face and thickness in um, minimum width and space in um
METALS = (
    ("met1", 1.3761, 0.36, 0.14, 0.14),
    ("met2", 2.0061, 0.36, 0.14, 0.14),
    ("met3", 2.7861, 0.845, 0.3, 0.3),
    ("met4", 4.0211, 0.845, 0.3, 0.3),
    ("met5", 5.3711, 1.26, 1.6, 1.6),
)
RAISED_UM = 0.295
SURFACE_UM = 0.323  # "diff" of the same table
GATE = Metal("poly", SURFACE_UM, 0.18, "silicon", 0.15, 0.21)  # on an oxide of nm; without silicide, as silicon
FINGER_UM = 0.15, 0.27  # rules difftap.1 and difftap.3


def _stack(heights: str, raised_um: float) -> OpticalStack:
    metals = tuple(
        Metal(name, bottom + (raised_um if name != "met1" else 0), thickness, "aluminium", width, space)
        for name, bottom, thickness, width, space in METALS
    )
    oxide = metals[-1].bottom_um
    films = Film(0.9361, "silica"), Film(1.0111, "nitride"), Film(oxide, "silica"), Film(oxide + 0.4223, "nitride")
    return OpticalStack("sky130", heights, metals, films, SURFACE_UM, FINGER_UM, GATE)


STACKS = {name: _stack(name, raised) for name, raised in (("met2-2.006", 0.0), ("met2-2.301", RAISED_UM))}
