# Which cells may have high-threshold transistors, with the parasitics of the routed layout: estimates are too far off for it.
# OpenROAD leaves a net with a diode out of a SPEF in part: so the netlist of sign-off, which has none, and not the database.
source common.tcl

# The cells between the clock's port and its registers, as a dictionary: their edges are balanced against one another.
proc clock_cells {} {
  global clock
  set cells [dict create]
  set nets [expr {$clock eq "" ? "" : [list [[ord::get_db_block] findNet $clock]]}]
  while {[llength $nets]} {
    set nets [lassign $nets net]
    foreach pin [$net getITerms] {
      set inst [$pin getInst]
      if {![$pin isInputSignal] || [string match df* [[$inst getMaster] getName]]} { continue }
      if {[dict exists $cells [$inst getName]]} { continue }
      dict set cells [$inst getName] 1
      foreach out [$inst getITerms] {
        if {[$out isOutputSignal] && [$out getNet] ne "NULL"} { lappend nets [$out getNet] }
      }
    }
  }
  return $cells
}

# Names of the instances on a late path, and of those that drive what is beyond a limit or the inputs of such a driver,
# as a dictionary.
proc too_slow {margin} {
  set names [dict create]
  foreach path [find_timing_paths -path_delay max -slack_max $margin -endpoint_count 400 -group_count 400] {
    foreach point [get_property $path points] {
      set pin [plain_name [get_full_name [get_property $point pin]]]
      dict set names [string range $pin 0 [expr {[string last / $pin] - 1}]] 1
    }
  }
  set beyond [beyond_limits]
  if {![dict size $beyond]} { return $names }
  foreach net [[ord::get_db_block] getNets] {
    if {![is_beyond $net $beyond]} { continue }
    foreach driver [drivers $net] {
      dict set names [plain_name [$driver getName]] 1
      foreach pin [$driver getITerms] {
        if {![$pin isInputSignal] || [$pin getNet] eq "NULL"} { continue }
        foreach before [drivers [$pin getNet]] { dict set names [plain_name [$before getName]] 1 }
      }
    }
  }
  return $names
}

# Cells become their twins with high-threshold transistors, which leak a hundredth: of the same size, with the same pins,
# so that places and routes stay. Those of the clock stay; those that are too slow for it become plain again. The names of
# the twins.
proc raise_thresholds {margin} {
  global twin
  set db [ord::get_db]
  set fixed [clock_cells]
  set raised [dict create]
  foreach inst [[ord::get_db_block] getInsts] {
    set master [$db findMaster "[[$inst getMaster] getName]$twin"]
    if {$master eq "NULL" || [dict exists $fixed [$inst getName]]} { continue }
    dict set raised [plain_name [$inst getName]] [list $inst [$inst getMaster]]
    $inst swapMaster $master
  }
  for {set turn 0} {$turn < 30} {incr turn} {
    read_spef wires.spef; # a swap drops the parasitics of its nets
    set plain {}
    dict for {name _} [too_slow $margin] {
      if {[dict exists $raised $name]} { lappend plain $name }
    }
    if {![llength $plain]} { break }
    foreach name $plain {
      lassign [dict get $raised $name] inst master
      $inst swapMaster $master
      dict unset raised $name
    }
  }
  return [dict keys $raised]
}

read_netlist
set_propagated_clock [all_clocks]
set raised [raise_thresholds $setup_margin]
set file [open raised.txt w]
puts $file [join $raised \n]
close $file
measured raised_thresholds [llength $raised]
measured routed_beyond [dict size [beyond_limits]]
measured routed_setup_ns [worst_slack -max]
