"""A stand-in for `openroad`: a Tcl interpreter in which every command not in COMMANDS, and every key that the command
does not have, is an error; what was called goes to calls.txt, and files are written with the words of their command."""

import os
from pathlib import Path

from talbot.flow.openroad.test.commands import COMMANDS

PROCEDURE = """
set def {VERSION 5.8 ;
DESIGN placed ;
UNITS DISTANCE MICRONS 1000 ;
DIEAREA ( 0 0 ) ( 30000 20000 ) ;
COMPONENTS 1 ;
 - a sky130_fd_sc_hd__inv_1 + PLACED ( 0 0 ) N ;
END COMPONENTS
END DESIGN}
# Of the database: a block without nets
proc block {what} { return [expr {$what eq "getNets" ? {} : 1000}] }
proc check {name keys flags least most writes says arguments} {
  set log [open calls.txt a]; puts $log "$name $arguments"; close $log
  set rest {}; set file {}
  for {set i 0} {$i < [llength $arguments]} {incr i} {
    set word [lindex $arguments $i]
    if {$word in $flags} { continue }
    if {$word in $keys} {
      incr i
      if {$i >= [llength $arguments]} { error "$name $word: no value" }
      if {$word eq $writes} { set file [lindex $arguments $i] }
    } elseif {[regexp {^-[a-z]} $word]} {
      error "$name: unknown option $word"
    } else { lappend rest $word }
  }
  if {[llength $rest] < $least || [llength $rest] > $most} { error "$name: arguments {$rest}" }
  if {$writes eq "argument"} { set file [lindex $rest 0] }
  if {$file ne {}} { set out [open $file w]; puts $out [expr {$name eq "write_def" ? $::def : $name}]; close $out }
  if {$name eq "write_verilog"} { file copy -force netlist.v $file }
  if {[string match read_* $name] && ![file exists [lindex $rest 0]]} { error "$name: no file [lindex $rest 0]" }
  return $says
}
"""


def install(folder, commands=COMMANDS):
    """Put the stand-in into ``folder`` as 'openroad'. commands: dict name -> Command, or None for one it lacks."""
    folder = Path(folder)
    procs = "".join(
        f"namespace eval {name.rpartition('::')[0] or '::'} {{}}\n"
        f"proc {name} args {{ check {name} {{{' '.join(c.keys)}}} {{{' '.join(c.flags)}}} {c.least} "
        f"{c.most} {{{c.writes}}} {{{c.says}}} $args }}\n"
        for name, c in commands.items()
        if c
    )
    stub = folder / "stub.tcl"
    stub.write_text(PROCEDURE + procs + "if {[catch {source [lindex $argv end]} said]} { puts stderr $said; exit 1 }\n")
    program = folder / "openroad"
    program.write_text(f'#!/bin/sh\nexec tclsh "{stub}" "$@"\n')
    os.chmod(program, 0o755)
