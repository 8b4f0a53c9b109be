# Yosys: Verilog -> netlist of cells, registers named as in the Verilog. Run: yosys -c synth.tcl
yosys -import
source design.tcl
read_verilog -sv $rtl
synth -flatten -nofsm -top $top
check -assert
dfflibmap -liberty $synthesis_liberty
abc -D $period_ps -liberty $synthesis_liberty
setundef -zero
hilomap -singleton -hicell {*}$high -locell {*}$low
splitnets
opt_clean -purge
tee -o synth.stat stat -liberty $synthesis_liberty
# The cells' pins must be known for it
read_liberty -lib -ignore_miss_func $synthesis_liberty
yosys rename -wire -suffix _reg {*}$registers
write_verilog -noattr -noexpr -nohex -nodec netlist.v
