"""The register map for other tools, by PeakRDL: a site to browse, IP-XACT, a C header of structs."""

from pathlib import Path

from talbot.base.files import staged
from talbot.models.parameters.registers.map import compiled

HTML, IPXACT, HEADER = "html", "asp_chip.xml", "asp_chip_peakrdl.h"


def export(folder: Path) -> None:
    """Write the site (html/index.html), the IP-XACT component (IEEE 1685-2014) and the header into ``folder``."""
    from peakrdl_cheader.exporter import CHeaderExporter  # with the packages of the tests
    from peakrdl_html import HTMLExporter
    from peakrdl_ipxact import IPXACTExporter

    chip = compiled()
    with staged(folder) as part:
        # its **kwargs are annotated as if each were a dict
        HTMLExporter().export(chip, str(part / HTML), title="AspChip")  # pyright: ignore[reportArgumentType]
        IPXACTExporter(vendor="talbot", library="asp").export(chip, str(part / IPXACT))
        CHeaderExporter().export(chip, str(part / HEADER))
