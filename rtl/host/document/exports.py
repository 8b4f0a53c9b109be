"""The register map as a page, and by PeakRDL as IP-XACT."""

from collections.abc import Mapping
from pathlib import Path

from talbot.base.files import staged
from talbot.models.parameters.registers import register_map
from talbot.models.parameters.registers.map import compiled
from talbot.rtl.host.document import registers

PAGE, IPXACT = "registers.html", "asp_chip.xml"
SITE = "html"  # of earlier releases


def export(folder: Path, resets: Mapping[str, int] | None = None) -> None:
    """Write the page and the IP-XACT component (IEEE 1685-2014) into ``folder``.

    resets: values after reset that are not those of the default chip, by field.
    """
    from peakrdl_ipxact import IPXACTExporter  # with the packages of the tests

    chip, fields = compiled(resets), register_map().with_resets(resets or {})
    with staged(folder, (PAGE, IPXACT, SITE)) as part:
        (part / PAGE).write_text(registers.html(fields), encoding="utf-8")
        IPXACTExporter(vendor="talbot", library="asp").export(chip, str(part / IPXACT))
