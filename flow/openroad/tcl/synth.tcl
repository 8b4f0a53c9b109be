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
abc -D $period_ps -liberty $synthesis_liberty
setundef -zero
hilomap -singleton -hicell {*}$high -locell {*}$low
opt_clean -purge
tee -o synth.stat stat -liberty $synthesis_liberty
write_json netlist.json
