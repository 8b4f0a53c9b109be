# Yosys: Verilog -> a netlist of cells, and the registers' names in the Verilog. Run: yosys -c synth.tcl
yosys -import
source design.tcl
read_verilog -sv $rtl
design -save read
hierarchy -top $top
yosys proc
flatten
memory
techmap
simplemap
opt_clean
write_json registers.json
design -load read
synth -flatten -nofsm -top $top
script gates.ys
check -assert
dfflibmap -liberty $synthesis_liberty
# Mapped for delay, buffered and sized: Yosys's own script maps for area, which leaves the chip 6 ns late at 20. Cells
# alone get 6 tenths of the period; wires, clock and the world outside take the rest.
set steps "+strash; ifraig; scorr; dc2; strash; dch,-f; map,-B,0.9,{D}; topo; buffer,-c,-N,12; upsize,{D}; dnsize,{D}"
abc -D [expr {$period_ps * 6 / 10}] -liberty $synthesis_liberty -script $steps
setundef -zero
hilomap -singleton -hicell {*}$high -locell {*}$low
opt_clean -purge
tee -o synth.stat stat -liberty $synthesis_liberty
write_json netlist.json
