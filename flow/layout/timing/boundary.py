"""The timing of a netlist at its ports: which input reaches what, and delays and constraints measured with OpenSTA.

OpenSTA's slacks at a grid of slews and loads are the model (2.0.17 had no `write_timing_model`).
OpenSTA 2.7.0 does not update a net when a port's load changes, so the SPEF is read again for each load.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from talbot.flow.layout.timing.opensta import LINK, opensta
from talbot.signoff.netlist.netlist import OUTPUT_PINS, Netlist, is_register

FAR_NS = 100.0  # clock period of the measurement; OpenSTA computes in single precision
CHECK_SLEW_NS, CHECK_LOAD_PF = 0.09, 0.027  # off every grid: where a model is compared with its netlist
LOAD = (
    f"{LINK}{{spef}}"
    + """
create_clock -name {clock} -period {period:g} [get_ports {clock}]
set_propagated_clock [get_clocks {clock}]
set sta_report_default_digits 6
proc name {{path end}} {{ return [get_full_name [get_property $path $end]] }}
proc named {{sign}} {{ return [expr {{$sign eq "^" ? "rise" : "fall"}}] }}
proc group {{name args}} {{
  group_path -name $name {{*}}$args
  lappend ::groups $name
}}
proc worst {{kind}} {{ return [find_timing_paths -path_group $::groups -path_delay $kind] }}
"""
)
# OpenSTA 2.7.0 keeps the reduced parasitics of a net when the load of its port changes: each load reads the SPEF again.
# A search goes over the whole netlist, and finds the worst path of each group: one for each row of the tables
OUTPUTS = """
set_output_delay 0 -clock {clock} [all_outputs]
set_false_path -from [get_ports {{{inputs}}}]
set ports [get_ports {{{outputs}}}]
foreach edge {{rise fall}} {{
  foreach port $ports {{ group "$edge [get_full_name $port]" -${{edge}}_to $port }}
}}
foreach load {{{loads}}} {{
  set_load $load [all_outputs]
  {spef}
  foreach slew {{{slews}}} {{
    set_input_transition $slew [all_inputs]
    foreach path [worst max] {{
      puts "DELAY {clock} [name $path endpoint] [named [$path end_transition]] $slew $load [get_property $path slack]"
    }}
    puts "SLEW $slew $load"
    foreach port $ports {{ report_slews $port }}
  }}
}}
"""
THROUGH = """
set_output_delay 0 -clock {clock} [all_outputs]
set_input_delay 0 -clock {clock} [get_ports {{{inputs}}}]
foreach edge {{rise fall}} {{
  foreach {{from to}} {{{pairs}}} {{
    group "$edge $from $to" -from [get_ports $from] -${{edge}}_to [get_ports $to]
  }}
}}
foreach load {{{loads}}} {{
  set_load $load [all_outputs]
  {spef}
  foreach slew {{{slews}}} {{
    set_input_transition $slew [all_inputs]
    foreach path [worst max] {{
      set ends "[name $path startpoint] [name $path endpoint]"
      puts "DELAY $ends [named [$path end_transition]] $slew $load [get_property $path slack]"
    }}
  }}
}}
"""
CONSTRAINTS = """
set ports [get_ports {{{inputs}}}]
set_input_delay 0 -clock {clock} $ports
foreach edge {{rise fall}} {{
  foreach port $ports {{ group "$edge [get_full_name $port]" -${{edge}}_from $port }}
}}
foreach clock_slew {{{slews}}} {{
  set_input_transition $clock_slew [get_ports {clock}]
  foreach slew {{{slews}}} {{
    set_input_transition $slew $ports
    foreach kind {{max min}} {{
      foreach path [worst $kind] {{
        set edge [named [lindex [[lindex [get_property $path points] 0] tag] 1]]
        puts "CHECK [name $path startpoint] $kind $edge $clock_slew $slew [get_property $path slack]"
      }}
    }}
  }}
}}
"""
PORTS = """
foreach port {{{inputs}}} {{ puts "PORT $port"; report_net -connections -verbose -digits 6 $port }}
"""


Point = tuple[float, float]  # of a grid: (slew ns, load pF), or of a constraint (clock's slew, input's slew), ns


@dataclass(frozen=True)
class Boundary:
    """Timing at the ports, ns.

    capacitance: input -> pF. delays: (from, output, edge) -> table. slews: (output, edge) -> table. checks: (input,
    'max' or 'min', edge) -> table of setup or hold. A table maps points of the grid to ns.
    """

    capacitance: dict[str, float]
    delays: dict[tuple[str, str, str], dict[Point, float]]
    slews: dict[tuple[str, str], dict[Point, float]]
    checks: dict[tuple[str, str, str], dict[Point, float]]


@dataclass(frozen=True)
class Sources:
    """What OpenSTA reads. folder: of its scripts. top: the module, where it is not that of the netlist."""

    liberty: Path
    verilog: Path
    folder: Path
    spef: Path | None = None
    top: str = ""


def reach(netlist: Netlist, clock: str) -> tuple[list[tuple[str, str]], list[str]]:
    """Pairs (input, output) joined by cells alone, and inputs that reach a register; sorted, without the clock."""
    drives: dict[str, set[str]] = {}
    ends = set()
    for instance in netlist.instances:
        outputs = set(instance.pins).intersection(OUTPUT_PINS)
        for pin in set(instance.pins) - outputs:
            if is_register(instance.cell):
                ends.add(instance.pins[pin])
            else:
                drives.setdefault(instance.pins[pin], set()).update(instance.pins[out] for out in outputs)
    outputs = set(_nets(netlist, "output"))
    pairs, kept = [], []
    for source in _nets(netlist, "input"):
        seen, todo = {source}, [source]
        while todo:
            new = drives.get(todo.pop(), set()) - seen
            seen |= new
            todo += new
        if source != clock:
            pairs += [(source, out) for out in sorted(seen & outputs)]
            kept += [source] if seen & ends else []
    return sorted(pairs), sorted(kept)


def _nets(netlist: Netlist, direction: str) -> list[str]:
    return [net for port in netlist.ports if port.direction == direction for net in port.bits()]


def measure(netlist: Netlist, clock: str, files: Sources, slews: Sequence[float], loads: Sequence[float]) -> Boundary:
    """Measure ``netlist`` on the grid of ``slews`` (ns) and ``loads`` (pF). Raises StepError, ToolError."""
    pairs, registered = reach(netlist, clock)
    inputs, outputs = _nets(netlist, "input"), _nets(netlist, "output")
    words = {"liberty": files.liberty, "verilog": files.verilog, "top": files.top or netlist.name}
    words |= {"clock": clock, "period": FAR_NS, "spef": f"read_spef {files.spef}" if files.spef else ""}
    words |= {"slews": " ".join(map(str, slews)), "loads": " ".join(map(str, loads))}
    words["pairs"] = " ".join(f"{{{a}}} {{{b}}}" for a, b in pairs)
    runs = [(OUTPUTS, {"outputs": outputs, "inputs": [net for net in inputs if net != clock]})]
    if pairs:
        runs.append((THROUGH, {"inputs": sorted({a for a, _ in pairs})}))
    if registered:
        runs.append((CONSTRAINTS, {"inputs": registered}))
    runs.append((PORTS, {"inputs": inputs}))
    printed = []
    for k, (script, ports) in enumerate(runs):
        lists = {name: " ".join(f"{{{net}}}" for net in nets) for name, nets in ports.items()}
        printed.append(opensta(files.folder / f"boundary{k}.log", (LOAD + script).format(**words | lists)))
    return _boundary("\n".join(printed))


def _boundary(printed: str) -> Boundary:
    """Parse OpenSTA's output of the scripts."""
    found, at, port = Boundary({}, {}, {}, {}), (0.0, 0.0), ""
    for line in printed.splitlines():
        word, *rest = line.split() or [""]
        if word == "DELAY":
            source, output, edge, slew, load, slack = rest
            found.delays.setdefault((source, output, edge), {})[float(slew), float(load)] = FAR_NS - float(slack)
        elif word == "CHECK":
            source, kind, edge, clock_slew, slew, slack = rest
            table = found.checks.setdefault((source, kind, edge), {})
            table[float(clock_slew), float(slew)] = FAR_NS - float(slack) if kind == "max" else -float(slack)
        elif word == "SLEW":
            at = float(rest[0]), float(rest[1])
        elif word == "PORT":
            port = rest[0]
        elif match := re.match(r"(\S+) \^ \S+?:(\S+) v \S+?:(\S+)", line):
            for edge, value in (("rise", match[2]), ("fall", match[3])):
                found.slews.setdefault((match[1], edge), {})[at] = float(value)
        elif line.startswith(" Total capacitance:"):  # one number, a range, or these for rise and fall
            found.capacitance[port] = max(map(float, re.findall(r"\d+\.\d+", line)))
    return found
