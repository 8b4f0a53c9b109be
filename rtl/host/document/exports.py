"""The register map for other tools: a page, and by PeakRDL IP-XACT and a C header of structs."""

from collections.abc import Mapping
from pathlib import Path

from talbot.base.files import staged
from talbot.models.parameters.registers import register_map
from talbot.models.parameters.registers.map import compiled
from talbot.rtl.host.document import registers

PAGE, IPXACT, HEADER = "registers.html", "asp_chip.xml", "asp_chip_peakrdl.h"
SITE = "html"  # of earlier releases


def export(folder: Path, resets: Mapping[str, int] | None = None) -> None:
    """Write the page, the IP-XACT component (IEEE 1685-2014) and the header into ``folder``.

    resets: values after reset that are not those of the default chip, by field.
    """
    from peakrdl_cheader.exporter import CHeaderExporter  # with the packages of the tests
    from peakrdl_ipxact import IPXACTExporter

    chip, fields = compiled(resets), register_map().with_resets(resets or {})
    with staged(folder, (PAGE, IPXACT, HEADER, SITE)) as part:
        (part / PAGE).write_text(registers.html(fields, listed=True), encoding="utf-8")
        IPXACTExporter(vendor="talbot", library="asp").export(chip, str(part / IPXACT))
        CHeaderExporter().export(chip, str(part / HEADER))
