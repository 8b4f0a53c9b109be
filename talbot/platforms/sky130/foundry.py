"""SKY130 as open_pdks installs it: SkyWater's manufacturing rules for KLayout, Magic's technology."""

from talbot.platforms.foundry import FoundryChecks

CHECKS = FoundryChecks(
    klayout="sky130A/libs.tech/klayout/drc/sky130A_mr.drc",
    defines=(("feol", "true"), ("beol", "true"), ("offgrid", "true"), ("floating_met", "false"), ("seal", "false")),
    magic="sky130A/libs.tech/magic",
    rc="sky130A.magicrc",
)
