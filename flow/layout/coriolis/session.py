"""Coriolis set up for a process and a library."""

import re
import sys

from flow.layout.netlist.names import CLOCK


def configure(request):
    """Load technology and cells as the library step exported them; returns CRL's framework."""
    sys.path.insert(0, request["library"])
    from coriolis import CRL, Cfg
    from coriolis.helpers import overlay
    from exported import StdCellLib, techno

    techno.setup()
    StdCellLib.setup()
    with overlay.CfgCache(priority=Cfg.Parameter.Priority.UserFile) as cfg:
        cfg.misc.catchCore = False
        cfg.misc.info = cfg.misc.paranoid = cfg.misc.bug = False
        cfg.misc.logMode = cfg.misc.verboseLevel1 = True
        cfg.misc.verboseLevel2 = False
        cfg.etesian.effort = request["effort"]
        cfg.anabatic.topRoutingLayer = request["wires"][-1]["name"]
    framework = CRL.AllianceFramework.get()
    environment = framework.getEnvironment()
    environment.setCLOCK(f"^{re.escape(CLOCK)}$")
    environment.setPOWER("vdd")
    environment.setGROUND("vss")
    return framework


def load(name):
    """The netlist <name>.blif of the working directory as a Hurricane cell."""
    from coriolis import CRL

    cell = CRL.Blif.load(name)
    if cell is None:
        raise SystemExit(f"coriolis: {name}.blif could not be read")
    return cell
