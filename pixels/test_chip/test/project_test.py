"""The shuttle's files: a module and an info.yaml that agree with the circuit."""

import re

from talbot.pixels.test_chip import project
from talbot.pixels.test_chip.circuit import ANALOG, INPUTS, NAME


def test_info_describes_every_pin_that_is_used_and_no_other():
    pins = dict(re.findall(r'^  (u[aio]+\[\d\]): "(.*)"$', project.info(), re.M))
    assert len(pins) == 24 + 6
    used = {name for name, text in pins.items() if text}
    assert used == {pin.replace("_in", "") for pin in INPUTS} | set(ANALOG)
    assert f"analog_pins: {len(ANALOG)}" in project.info()


def test_the_stub_has_all_ports_and_ties_the_outputs():
    text = project.stub()
    assert f"module {NAME} (" in text
    for port in (
        "VGND",
        "VDPWR",
        "VAPWR",
        "ui_in",
        "uo_out",
        "uio_in",
        "uio_out",
        "uio_oe",
        "ua",
        "ena",
        "clk",
        "rst_n",
    ):
        assert re.search(rf" {port}\b", text)
    assert all(f"assign {name} = 8'b0;" in text for name in ("uo_out", "uio_out", "uio_oe"))
