# Supplies: the cells' pins to the nets, rails, straps. A core narrower than a pair of straps has one pair.
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
set block [ord::get_db_block]
set core_box [$block getCoreArea]
set core_width [expr {([$core_box xMax] - [$core_box xMin]) / double([$block getDbUnitsPerMicron])}]
set below {}
foreach strap $straps {
  lassign $strap layer width pitch offset
  if {$pitch == 0} {
    add_pdn_stripe -grid grid -layer $layer -width $width -followpins
  } else {
    if {$pitch > $core_width} {
      set pitch [expr {floor($core_width / (4 * $site_width)) * 4 * $site_width}]
      set offset [expr {$pitch / 4}]
    }
    add_pdn_stripe -grid grid -layer $layer -width $width -pitch $pitch -offset $offset
  }
  if {$below ne {}} {
    set columns [expr {$strap_columns ? [list -max_columns $strap_columns] : ""}]
    add_pdn_connect -grid grid -layers [list $below $layer] {*}$columns
  }
  set below $layer
}
pdngen
write_db power.odb
