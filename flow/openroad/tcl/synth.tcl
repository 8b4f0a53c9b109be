# Yosys: Verilog -> netlist of cells. Run: yosys -c synth.tcl
yosys -import
source design.tcl
read_verilog -sv $rtl
synth -flatten -top $top
check -assert
dfflibmap -liberty $synthesis_liberty
abc -D $period_ps -liberty $synthesis_liberty
setundef -zero
hilomap -singleton -hicell {*}$high -locell {*}$low
splitnets
opt_clean -purge
tee -o synth.stat stat -liberty $synthesis_liberty
write_verilog -noattr -noexpr -nohex -nodec netlist.v
