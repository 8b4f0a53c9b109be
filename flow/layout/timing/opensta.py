"""OpenSTA run on a script, as a part of OpenROAD."""

import re
from pathlib import Path

from talbot.base import openroad
from talbot.base.steps import StepError
from talbot.base.tools import ToolError, finish

LINK = """
read_liberty {liberty}
read_verilog {verilog}
link_design {top}
"""
TIMED = f"{LINK}source {{sdc}}\nread_spef {{spef}}\n"  # of a netlist with its constraints and parasitics
# OpenROAD links a netlist to the cells of a LEF: here all cells of the Liberty, with their pins and no shapes
CELLS = """
rename link_design linked
proc link_design {top} {
  set path $::cells_lef
  set file [open $path w]
  puts $file {VERSION 5.8 ; BUSBITCHARS "[]" ; DIVIDERCHAR "/" ; UNITS DATABASE MICRONS 1000 ; END UNITS}
  puts $file {LAYER m TYPE ROUTING ; DIRECTION HORIZONTAL ; PITCH 1 ; WIDTH 0.5 ; END m}
  foreach cell [get_lib_cells */*] {
    set name [get_property $cell name]
    puts $file "MACRO $name CLASS CORE ; SIZE 1 BY 1 ;"
    foreach pin [get_lib_pins [get_property $cell full_name]/*] {
      set direction [string toupper [get_property $pin direction]]
      set port [get_property $pin name]
      if {$direction in {INPUT OUTPUT INOUT}} { puts $file "PIN $port DIRECTION $direction ; END $port" }
    }
    puts $file "END $name"
  }
  puts $file {END LIBRARY}
  close $file
  read_lef $path
  linked $top
}
"""


def worst_slack(report: str, kind: str) -> float:
    """Slack (ns) that a script printed as "WORST kind ns". Raises StepError without one."""
    found = re.search(rf"WORST {re.escape(kind)} (\S+)", report)
    if not found:
        raise StepError(f"OpenSTA: no slack of {kind}")
    return float(found[1])


def opensta(path: Path, script: str) -> str:
    """Write ``script`` to the file ``path`` and run it; OpenSTA's output.

    Raises ToolError when it fails; StepError where it reports an error, or a name of the SPEF that it does not
    know, whose parasitics would be missing from every figure.
    """
    lef = path.with_suffix(".lef")
    path.write_text(f"set cells_lef {{{lef}}}\n{CELLS}{script}\nexit\n", encoding="utf-8")
    try:
        done = finish(openroad.command(path))
    finally:
        lef.unlink(missing_ok=True)  # no file of a step
    output = (done.stdout + done.stderr).strip().splitlines()
    if wrong := next((line for line in output if re.search(r"Error|\[ERROR", line)), None):
        raise StepError(f"{path.stem}: OpenSTA: {wrong}")
    if done.returncode:
        message = (done.stderr.strip().splitlines() or output or [""])[0]
        raise ToolError(f"{path.stem}: OpenSTA failed with status {done.returncode}: {message}")
    if lost := next((line for line in output if re.search(r"spef.*not found", line)), None):
        raise StepError(f"{path.stem}: OpenSTA does not know a name of the SPEF: {lost}")
    return done.stdout
