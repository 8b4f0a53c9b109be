"""SG13G2's optical stack.

Heights and films: IHP's SG13G2 as klayout-pex 0.6.12 (ihp-sg13g2_tech.pb.json, process stack) and [Edwards2024]
(ihp-sg13g2/metal_stack_ihp-sg13g2.py) have them; minimum widths and spaces: the latter. All metals are aluminium, all
oxides are taken as silica.
"""

from talbot.platforms.optics import Film, Metal, OpticalStack

METALS = (
    Metal("Metal1", 1.04, 0.42, "aluminium", 0.16, 0.18),
    Metal("Metal2", 2.00, 0.49, "aluminium", 0.20, 0.21),
    Metal("Metal3", 3.03, 0.49, "aluminium", 0.20, 0.21),
    Metal("Metal4", 4.06, 0.49, "aluminium", 0.20, 0.21),
    Metal("Metal5", 5.09, 0.49, "aluminium", 0.20, 0.21),
    Metal("TopMetal1", 6.43, 2.0, "aluminium", 1.64, 1.64),
    Metal("TopMetal2", 11.23, 3.0, "aluminium", 2.0, 2.0),
)
FILMS = Film(0.40, "silica"), Film(0.45, "nitride"), Film(12.73, "silica"), Film(13.13, "nitride")
SURFACE_UM = 0.3976  # "diff" of the same table
FINGER_UM = 0.15, 0.21  # rules Act.a and Act.b
STACKS = {"klayout-pex": OpticalStack("ihp-sg13g2", "klayout-pex", METALS, FILMS, SURFACE_UM, FINGER_UM)}
