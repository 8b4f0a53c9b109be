"""A netlist as its ports see it: which input reaches what, and delays and constraints measured there with OpenSTA.

Debian's OpenSTA (2.0.17) has no `write_timing_model`: its slacks at a grid of slews and loads are that model here.
"""

import re
from dataclasses import dataclass

from flow.layout.netlist.netlist import OUTPUT_PINS, is_register

from .opensta import opensta

FAR_NS = 100.0  # clock period of the measurement; OpenSTA computes in single precision
CHECK_SLEW_NS, CHECK_LOAD_PF = 0.09, 0.027  # beside every grid: where a model made from one is held to its source
LOAD = """
read_liberty {liberty}
read_verilog {verilog}
link_design {top}
{spef}
create_clock -name {clock} -period {period:g} [get_ports {clock}]
set_propagated_clock [get_clocks {clock}]
set sta_report_default_digits 6
proc slack {{args}} {{
  set ends [find_timing_paths {{*}}$args]
  if {{[llength $ends]}} {{ return [get_property [lindex $ends 0] slack] }}
  return none
}}
"""
OUTPUTS = """
set_output_delay 0 -clock {clock} [all_outputs]
set_false_path -from [get_ports {{{inputs}}}]
foreach slew {{{slews}}} {{
  set_input_transition $slew [all_inputs]
  foreach load {{{loads}}} {{
    set_load $load [all_outputs]
    foreach port {{{outputs}}} {{
      foreach edge {{rise fall}} {{
        puts "DELAY {clock} $port $edge $slew $load [slack -${{edge}}_to [get_ports $port] -path_delay max]"
      }}
      puts "SLEW $slew $load"; report_slews [get_ports $port]
    }}
  }}
}}
"""
THROUGH = """
set_output_delay 0 -clock {clock} [all_outputs]
set_input_delay 0 -clock {clock} [get_ports {{{inputs}}}]
foreach slew {{{slews}}} {{
  set_input_transition $slew [all_inputs]
  foreach load {{{loads}}} {{
    set_load $load [all_outputs]
    foreach {{from to}} {{{pairs}}} {{
      foreach edge {{rise fall}} {{
        puts "DELAY $from $to $edge $slew $load \\
[slack -from [get_ports $from] -${{edge}}_to [get_ports $to] -path_delay max]"
      }}
    }}
  }}
}}
"""
CONSTRAINTS = """
set_input_delay 0 -clock {clock} [get_ports {{{inputs}}}]
foreach slew {{{slews}}} {{
  set_input_transition $slew [get_ports {{{inputs}}}]
  foreach clock_slew {{{slews}}} {{
    set_input_transition $clock_slew [get_ports {clock}]
    foreach port {{{inputs}}} {{
      foreach edge {{rise fall}} {{
        foreach kind {{max min}} {{
          puts "CHECK $port $kind $edge $clock_slew $slew [slack -${{edge}}_from [get_ports $port] -path_delay $kind]"
        }}
      }}
    }}
  }}
}}
"""
PORTS = """
foreach port {{{inputs}}} {{ puts "PORT $port"; report_net -connections -verbose -digits 6 $port }}
"""


@dataclass(frozen=True)
class Boundary:
    """capacitance: input -> pF. delays: (from, output, edge) -> {(slew ns, load pF): ns}. slews: (output, edge) -> the
    same. checks: (input, 'max' or 'min', edge) -> {(clock's slew, input's slew): ns}: setup and hold."""

    capacitance: dict
    delays: dict
    slews: dict
    checks: dict


def reach(netlist, clock):
    """(pairs (input, output) joined by cells alone, inputs that reach a register), each sorted, the clock left out."""
    drives, ends = {}, set()
    for instance in netlist.instances:
        outputs = set(instance.pins).intersection(OUTPUT_PINS)
        for pin in set(instance.pins) - outputs:
            if is_register(instance.cell):
                ends.add(instance.pins[pin])
            else:
                drives.setdefault(instance.pins[pin], set()).update(instance.pins[out] for out in outputs)
    outputs = {net for port in netlist.ports if port.direction == "output" for net in port.bits()}
    pairs, kept = [], []
    for source in (net for port in netlist.ports if port.direction == "input" for net in port.bits()):
        seen, todo = {source}, [source]
        while todo:
            new = drives.get(todo.pop(), set()) - seen
            seen |= new
            todo += new
        if source != clock:
            pairs += [(source, out) for out in sorted(seen & outputs)]
            kept += [source] if seen & ends else []
    return sorted(pairs), sorted(kept)


def measure(netlist, clock, files, slews, loads):
    """The Boundary of ``netlist`` (Netlist). files: paths liberty, verilog, folder (of scripts), spef where
    there is one; top: the module where it is not that of the netlist. slews: ns, loads: pF. Raises
    StepError, ToolError."""
    pairs, registered = reach(netlist, clock)
    nets = {
        way: [net for port in netlist.ports if port.direction == way for net in port.bits()]
        for way in ("input", "output")
    }
    words = {
        "clock": clock,
        "top": files.get("top", netlist.name),
        "period": FAR_NS,
        "liberty": files["liberty"],
        "verilog": files["verilog"],
        "spef": f"read_spef {files['spef']}" if files.get("spef") else "",
        "slews": " ".join(map(str, slews)),
        "loads": " ".join(map(str, loads)),
        "pairs": " ".join(f"{{{a}}} {{{b}}}" for a, b in pairs),
    }

    def ask(script, folder, **more):
        lists = {name: " ".join(f"{{{net}}}" for net in value) for name, value in more.items()}
        said.append(opensta(folder / f"boundary{len(said)}.log", (LOAD + script).format(**words | lists)))

    said = []
    ask(OUTPUTS, files["folder"], outputs=nets["output"], inputs=[net for net in nets["input"] if net != clock])
    if pairs:
        ask(THROUGH, files["folder"], inputs=sorted({a for a, _ in pairs}))
    if registered:
        ask(CONSTRAINTS, files["folder"], inputs=registered)
    ask(PORTS, files["folder"], inputs=nets["input"])
    return _boundary("\n".join(said))


def _boundary(said):
    """From what OpenSTA printed."""
    capacitance, delays, slews, checks, at = {}, {}, {}, {}, None
    for line in said.splitlines():
        word, *rest = line.split() or [""]
        if word == "DELAY" and rest[-1] != "none":
            source, port, edge, slew, load, slack = rest
            delays.setdefault((source, port, edge), {})[float(slew), float(load)] = FAR_NS - float(slack)
        elif word == "CHECK" and rest[-1] != "none":
            port, kind, edge, clock_slew, slew, slack = rest
            checks.setdefault((port, kind, edge), {})[float(clock_slew), float(slew)] = (
                FAR_NS - float(slack) if kind == "max" else -float(slack)
            )
        elif word in ("SLEW", "PORT"):
            at = tuple(map(float, rest)) if word == "SLEW" else rest[0]
        elif found := re.match(r"(\S+) \^ \S+?:(\S+) v \S+?:(\S+)", line):
            for edge, value in (("rise", found[2]), ("fall", found[3])):
                slews.setdefault((found[1], edge), {})[at] = float(value)
        elif line.startswith(" Total capacitance:"):  # one number, a range, or these for rise and fall
            capacitance[at] = max(map(float, re.findall(r"\d+\.\d+", line)))
    return Boundary(capacitance, delays, slews, checks)
