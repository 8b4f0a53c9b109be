# Supplies: the cells' pins to the nets, rails, straps.
source common.tcl
open_stage floorplan
foreach pin $supply_pins {
  add_global_connection -net $supply -inst_pattern {.*} -pin_pattern "^$pin\$" -power
}
foreach pin $ground_pins {
  add_global_connection -net $ground -inst_pattern {.*} -pin_pattern "^$pin\$" -ground
}
global_connect
set_voltage_domain -name CORE -power $supply -ground $ground
define_pdn_grid -name grid -voltage_domains CORE -pins [lindex [lindex $straps end] 0]
set below {}
foreach strap $straps {
  lassign $strap layer width pitch offset
  if {$pitch == 0} {
    add_pdn_stripe -grid grid -layer $layer -width $width -followpins
  } else {
    add_pdn_stripe -grid grid -layer $layer -width $width -pitch $pitch -offset $offset
  }
  if {$below ne {}} {
    add_pdn_connect -grid grid -layers [list $below $layer]
  }
  set below $layer
}
pdngen
write_db power.odb
