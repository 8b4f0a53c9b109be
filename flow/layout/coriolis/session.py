"""Coriolis set up for a process and a library."""

import re
import sys
from typing import Any

from talbot.flow.layout.netlist.names import CLOCK


def configure(request: dict[str, Any]) -> None:
    """Load technology and cells as the library step exported them."""
    sys.path.insert(0, request["library"])
    from coriolis import CRL, Cfg  # pyright: ignore[reportAttributeAccessIssue]  # compiled, without stubs
    from coriolis.helpers import overlay
    from exported import StdCellLib, techno  # pyright: ignore[reportMissingImports]  # written by the library step

    techno.setup()
    StdCellLib.setup()
    with overlay.CfgCache(priority=Cfg.Parameter.Priority.UserFile) as cfg:
        cfg.misc.catchCore = False
        cfg.misc.info = cfg.misc.paranoid = cfg.misc.bug = False
        cfg.misc.logMode = cfg.misc.verboseLevel1 = True
        cfg.misc.verboseLevel2 = False
        cfg.etesian.effort = 1  # `arrange` places the cells again
        cfg.anabatic.topRoutingLayer = request["metals"][-1]["name"]
    environment = CRL.AllianceFramework.get().getEnvironment()
    environment.setCLOCK(f"^{re.escape(CLOCK)}$")
    environment.setPOWER("vdd")
    environment.setGROUND("vss")


def load(name: str) -> Any:
    """Load the netlist <name>.blif of the working directory as a Hurricane cell."""
    from coriolis import CRL  # pyright: ignore[reportAttributeAccessIssue]  # compiled, without stubs

    cell = CRL.Blif.load(name)
    if cell is None:
        raise SystemExit(f"coriolis: {name}.blif could not be read")
    return cell
