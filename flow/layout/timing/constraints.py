"""Clock, variation, I/O delays, slews and loads of a design as SDC: one text for synthesis, STA and OpenROAD."""

from talbot.flow.layout.design import Design


def sdc(design: Design, propagated: bool = True) -> str:
    """Text of the SDC (ns, pF). propagated: whether the clock has the delays of its tree, once there is one."""
    clock, io = design.clock, design.io
    tree = f"set_propagated_clock [get_clocks {{{clock.port}}}]\n" if propagated else ""
    pins = " ".join(design.asynchronous)
    untimed = f"set_false_path -from [get_ports {{{pins}}}]\n" if pins else ""
    return f"""create_clock -name {clock.port} -period {clock.period_ns:g} [get_ports {{{clock.port}}}]
set_clock_uncertainty -setup {clock.uncertainty_ns:g} [get_clocks {{{clock.port}}}]
set_clock_uncertainty -hold {clock.hold_uncertainty_ns:g} [get_clocks {{{clock.port}}}]
set_timing_derate -early {1 - clock.derate:g}
set_timing_derate -late {1 + clock.derate:g}
{tree}set data_inputs {{}}
foreach port [all_inputs] {{
  if {{[get_property $port full_name] ne "{clock.port}"}} {{ lappend data_inputs $port }}
}}
set_input_delay -max {io.input_delay * clock.period_ns:g} -clock {clock.port} $data_inputs
set_input_delay -min {io.input_hold_ns:g} -clock {clock.port} $data_inputs
set_output_delay -max {io.output_delay * clock.period_ns:g} -clock {clock.port} [all_outputs]
set_output_delay -min {-io.output_hold_ns:g} -clock {clock.port} [all_outputs]
{untimed}set_input_transition {io.input_slew_ns:g} [all_inputs]
set_load {io.load_pf:g} [all_outputs]
"""
