"""The register map for other tools: a page, and by PeakRDL IP-XACT and a C header of structs."""

from pathlib import Path

from talbot.base.files import staged
from talbot.models.parameters.registers import register_map
from talbot.models.parameters.registers.map import compiled

from . import registers

PAGE, IPXACT, HEADER = "registers.html", "asp_chip.xml", "asp_chip_peakrdl.h"
SITE = "html"  # of earlier releases


def export(folder: Path) -> None:
    """Write the page, the IP-XACT component (IEEE 1685-2014) and the header into ``folder``."""
    from peakrdl_cheader.exporter import CHeaderExporter  # with the packages of the tests
    from peakrdl_ipxact import IPXACTExporter

    chip = compiled()
    with staged(folder, (PAGE, IPXACT, HEADER, SITE)) as part:
        (part / PAGE).write_text(registers.html(register_map(), listed=True), encoding="utf-8")
        IPXACTExporter(vendor="talbot", library="asp").export(chip, str(part / IPXACT))
        CHeaderExporter().export(chip, str(part / HEADER))
