"""Mutants of the exported SystemVerilog's text: wrong lines of RTL, and bugs that act rarely.

The export has a statement a line and parentheses around every operand. A mutant replaces the right side of a
statement, or a condition, where the input ``mutant`` selects it; a triggered one flips a bit of many.
"""

import random
import re
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

from talbot.signoff.netlist.verilog import modules
from talbot.verif.coverage.measure import sources_of
from talbot.verif.mutation.mutants import BITS, PREPARE, Mutant, own_modules, yosys

OTHER = {"+": "-", "-": "+", "&": "|", "|": "&", "^": "|", "<": "<=", "<=": "<", ">": ">=", ">=": ">"}
OTHER |= {"==": "!=", "!=": "==", "<<": "<< 1 <<", ">>": ">> 1 >>"}
OPERATOR = re.compile(r" ([-+&|^]|[<>]=?|[!=]=|<<|>>) ")
CONSTANT = re.compile(r"(?<![:\w])(\d+)'(?:d(\d+)|\( (__const__\w+) \))(?!:)")  # those of a part select have a colon
STATEMENT = re.compile(r"(\s+(?:assign )?)(?!localparam|logic|for )(\S.*?) (<?=) (.*);")
CONDITION = re.compile(r"(\s+(?:else )?if )\( (.*) \) begin")
PAIRS = "()", "[]", "{}"
IT = "<it>"  # the name of a mutant's own signal, in its text


@dataclass
class Module:
    """A module of the export. width: by signal. state: its registers and inputs. parameter: values by name."""

    clocked: bool = False
    width: dict[str, int] = field(default_factory=dict)
    state: list[str] = field(default_factory=list)
    parameter: dict[str, int] = field(default_factory=dict)


class Line(NamedTuple):
    """A statement or a condition (target ''). reset: in the reset's branch. kept: it has a value without this line."""

    number: int
    head: str
    target: str
    assign: str
    value: str
    tail: str
    clocked: bool
    reset: bool
    kept: bool


class Change(NamedTuple):
    """A mutant of a line. value: its new right side. declared, always: text that this needs in the module."""

    kind: str
    line: Line
    value: str
    declared: str = ""
    always: str = ""


def modules_of(verilog: str) -> dict[str, Module]:
    """Return the declarations of each module."""
    declarations: dict[str, Module] = {}
    for name, body in modules(verilog).items():
        module = declarations[name] = Module("always_ff" in body)
        for way, high, signal in re.findall(r"(?m)^  (input +|output )?logic (?:\[(\d+):0\] )?(\w+) *[;,]?$", body):
            module.width[signal] = int(high or 0) + 1
            if way.startswith("input") and signal not in ("clk", "reset"):
                module.state.append(signal)
        module.state += [s for s in dict.fromkeys(re.findall(r"(?m)^ +(\w+) <= ", body)) if s in module.width]
        module.parameter = {k: int(v) for k, v in re.findall(r"localparam \S+ (?:\S+ )?(\w+) += \d+'d(\d+);", body)}
    return declarations


def lines_of(verilog: str) -> dict[str, list[Line]]:
    """Return the statements and conditions of each module."""
    lines, clocked, reset, looped = defaultdict(list), False, False, -1
    assigned: set[str] = set()
    for number, ((module, _), text) in enumerate(zip(sources_of(verilog)[1:], verilog.splitlines(), strict=True), 1):
        indent = len(text) - len(text.lstrip())
        if text.startswith("  always"):
            clocked, assigned, looped = "always_ff" in text, set(), -1
        elif indent == 4 and "begin" in text:
            reset = clocked and text.lstrip().startswith("if ( reset")
        looped = -1 if text.strip() and indent <= looped else looped
        if text.lstrip().startswith("for "):
            looped = indent
        if not module or looped >= 0 or text.lstrip().startswith("//"):
            continue  # a loop's variable is not seen outside
        if match := CONDITION.fullmatch(text):
            lines[module].append(
                Line(number, match[1] + "( ", "", "", match[2], " ) begin", clocked, indent == 4 and reset, False)
            )
        elif match := STATEMENT.fullmatch(text):
            _, target, assign, value = match.groups()
            kept = clocked or target in assigned
            head = f"{match[1]}{target} {assign} "
            lines[module].append(Line(number, head, target, assign, value, ";", clocked, reset and indent > 4, kept))
            assigned |= {target} if indent == 4 else set()
    return lines


def operators(line: Line, module: Module, rng: random.Random) -> Iterator[Change]:
    """Yield other operators, a concatenation in another order, a lost inversion, another signal of the same width."""
    value = line.value
    for match in OPERATOR.finditer(value):
        yield Change("operator", line, f"{value[: match.start()]} {OTHER[match[1]]} {value[match.end() :]}")
    for match in re.finditer(r"\{ ([^{},?]+), ([^{},?]+)(?=[,}])", value):
        if (first := match[1].strip()) != (second := match[2].strip()):
            yield Change("operator", line, f"{value[: match.start()]}{{ {second}, {first} {value[match.end() :]}")
    for match in re.finditer(r"~(?=[\w(])", value):
        yield Change("operator", line, value[: match.start()] + value[match.end() :])
    same = [signal for signal in module.state if module.width[signal] == module.width.get(value) and signal != value]
    if same:
        yield Change("operator", line, rng.choice(same))


def constants(line: Line, module: Module, rng: random.Random) -> Iterator[Change]:
    """Yield constants off by one, with another bit, at their edges."""
    for match in CONSTANT.finditer(line.value):
        width, literal, name = int(match[1]), match[2], match[3]
        most = (1 << width) - 1
        value = int(literal) if literal else module.parameter.get(name, 0) & most
        others = {value + 1, value - 1, value ^ 1 << rng.randrange(width), 0, most} - {value, -1, most + 1}
        new = rng.choice(sorted(others))
        yield Change("constant", line, f"{line.value[: match.start()]}{width}'d{new}{line.value[match.end() :]}")


def conditions(line: Line, module: Module, rng: random.Random) -> Iterator[Change]:
    """Yield conditions inverted and stuck, without an operand of an AND or OR, branches exchanged."""
    value = line.value
    if not line.target:
        yield from (Change("condition", line, new) for new in (f"~( {value} )", "1'd0", "1'd1"))
    for match in re.finditer(r" [&|] ", value):
        low, high = operand(value, match.start(), -1), operand(value, match.end() - 1, 1)
        yield Change("condition", line, value[:low] + value[match.end() : high] + value[high:])
        yield Change("condition", line, value[: match.start()] + value[high:])
    match = re.fullmatch(r"(.+?) \? (.+) : (.+)", value)
    if match and all(part.count(opened) == part.count(closed) for part in match.groups() for opened, closed in PAIRS):
        yield Change("condition", line, f"{match[1]} ? {match[3]} : {match[2]}")


def operand(value: str, at: int, step: int) -> int:
    """Return where the operand that ends or begins at ``at`` begins or ends: at the next bracket not closed in it."""
    depth, opening = 0, "([{" if step > 0 else ")]}"
    while 0 <= at < len(value) if step > 0 else at > 0:
        letter = value[at if step > 0 else at - 1]
        depth += letter in opening
        depth -= letter in "([{)]}" and letter not in opening
        if depth < 0 or not depth and letter in ",?:":
            break
        at += step
    return at + (step < 0 and at < len(value) and value[at] == " ") - (step > 0 and value[at - 1] == " ")


def registers(line: Line, module: Module, rng: random.Random) -> Iterator[Change]:
    """Yield a register without its reset, a value not taken, an enable that lasts a cycle longer."""
    if line.target and line.kept and line.value != line.target:
        yield Change("reset" if line.reset else "enable", line, line.target)
    elif not line.target and line.clocked and not line.reset:
        held = f"  always_ff @(posedge clk) {IT} <= ( {line.value} ) != 0;\n"
        yield Change("enable", line, f"( {line.value} ) | {IT}", f"  logic [0:0] {IT};\n", held)


def triggered(line: Line, module: Module, rng: random.Random) -> Iterator[Change]:
    """Yield one flipped bit: of a rare value, of several bits, once something has happened so often, or changed."""
    wide = [signal for signal in module.state if 3 <= module.width[signal] <= 10]
    width = module.width.get(line.target, 0)
    if line.reset or not width or not module.state or CONSTANT.fullmatch(line.value):
        return
    flip = f"( {line.value} ) ^ ( {IT} ? {width}'d{1 << rng.randrange(width)} : {width}'d0 )"
    declared = f"  logic [0:0] {IT};\n"
    if wide:
        signal = rng.choice(wide)
        rare = f"  assign {IT} = {signal} == {module.width[signal]}'d{rng.randrange(1 << module.width[signal])};\n"
        yield Change("trigger", line, flip, declared, rare)
    bits = sorted({(s, rng.randrange(module.width[s])) for s in rng.choices(module.state, k=rng.randrange(3, 7))})
    both = " & ".join(f"( {s}[{bit}] == 1'd{rng.randrange(2)} )" for s, bit in bits)
    yield Change("trigger", line, flip, declared, f"  assign {IT} = {both};\n")
    if not module.clocked:
        return
    signal, times = rng.choice(module.state), rng.randrange(2, 7)
    count = (
        f"  always_ff @(posedge clk) begin\n    {IT}_was <= {signal};\n"
        f"    {IT}_count <= reset ? 3'd0 : {IT}_count + 3'( ( {IT}_was != {signal} ) & ~{IT} );\n  end\n"
        f"  assign {IT} = {IT}_count == 3'd{times};\n"
    )
    declared += f"  logic [2:0] {IT}_count;\n  logic [{module.width[signal] - 1}:0] {IT}_was;\n"
    yield Change("trigger", line, flip, declared, count)


KINDS = operators, constants, conditions, registers, triggered


def rewritten(verilog: str, top: str, folder: str, number: int, seed: int) -> tuple[list[Mutant], str]:
    """Return ``number`` mutants of the modules of ``top`` from rtl/<folder>, as many of each kind, and all in one text.

    The text is Yosys's, as that of `mutants.with_mutants`, with an input `mutant` that selects one.
    """
    rng, modules, by_module = random.Random(seed), modules_of(verilog), lines_of(verilog)
    parts = defaultdict(list)
    for module in own_modules(verilog, folder):
        for line in by_module[module]:
            for kind in KINDS:
                for change in kind(line, modules[module], rng):
                    parts[change.kind, module].append((module, change))
    for changes in parts.values():
        rng.shuffle(changes)
    chosen: list[tuple[str, Change]] = []
    while len(chosen) < number and any(parts.values()):
        remaining = sorted(part for part, changes in parts.items() if changes)
        chosen += [parts[part].pop() for part in rng.sample(remaining, len(remaining))]
    where, lines = sources_of(verilog), ["", *verilog.splitlines()]
    mutants = [
        Mutant(i, f"{c.kind}: {c.value.replace(IT, 'it')} {c.always.strip()}", module, n := c.line.number,
               where[n].python, " ".join(lines[n].split()))
        for i, (module, c) in enumerate(chosen[:number], 1)
    ]  # fmt: skip
    script = f"{PREPARE.format(top=top)}; write_verilog -noattr mutants.v"
    return mutants, yosys(script, {"dut.v": planted(verilog, chosen[:number])})["mutants.v"].decode()


def planted(verilog: str, chosen: list[tuple[str, Change]]) -> str:
    """Return the Verilog with the mutants ``chosen``, numbered from 1, and the input that selects one."""
    lines = ["", *verilog.splitlines()]
    values = {change.line.number: change.line.value for _, change in chosen}
    declared, always = defaultdict(str), defaultdict(str)
    for number, (module, change) in enumerate(chosen, 1):
        name, line = f"mutant_{number}", change.line
        new = change.value.replace(IT, name)
        values[line.number] = f"( mutant == {BITS}'d{number} ) ? ( {new} ) : ( {values[line.number]} )"
        declared[module] += change.declared.replace(IT, name)
        always[module] += change.always.replace(IT, name)
        lines[line.number] = line.head + values[line.number] + line.tail
    text = "\n".join(lines[1:]) + "\n"
    text = re.sub(r"(?m)^(  \w+ \w+\n  \(\n)", r"\1    .mutant( mutant ),\n", text)
    port = f"  input logic [{BITS - 1}:0] mutant,\n"
    return re.sub(
        r"(?ms)^module (\w+)\n\(\n(.*?^\);\n)(.*?)(?=^endmodule)",
        lambda m: f"module {m[1]}\n(\n{port}{m[2]}{declared[m[1]]}{m[3]}{always[m[1]]}",
        text,
    )
