"""A PyMTL simulation that skips RTL blocks whose inputs have not changed.

PyMTL runs every block twice a cycle. Where most of a design waits, as between two bits of SPI, that takes nearly all of
a simulation's time.
"""

from collections.abc import Callable, Iterable
from typing import Any

from pymtl3 import Bits
from pymtl3.passes.sim.PrepareSimPass import PrepareSimPass

Block = Callable[[], None]
LOOP = "wrapped_SCC_"  # PyMTL's block of blocks that depend on each other begins with this name
OF_SIGNALS = "_rtl", ".harness.driven"  # modules whose blocks have no state outside the signals, or count it in one

HEAD = """
def settle():
  global moved, inputs
  given = {inputs}
  if moved or given != inputs:
{settle}
    moved, inputs = {always}, given

def edge():
  global moved
{edge}
"""


def quicken(top: Any) -> None:
    """Let the prepared simulation ``top`` skip a block of RTL (OF_SIGNALS) whose inputs have not changed.

    Other blocks may have a state outside the signals, and run always.
    """
    code = _Code(top)
    settle = [line for block in top._sched.update_schedule for line in code.guarded(block)]
    edge = [line for block in top._sched.schedule_ff for line in code.guarded(block, "moved = True")]
    ports = [s for s in top._dsl.all_signals if s.is_input_value_port() and s.get_host_component() is top]
    source = HEAD.format(
        inputs=code.values(ports), settle=_indented(settle, 4), edge=_indented(edge, 2), always=not code.pure
    )
    code.scope |= {"moved": True, "inputs": None}
    exec(source, code.scope)
    top._sched.update_schedule, top._sched.schedule_ff = [code.scope["settle"]], [code.scope["edge"]]
    prepare = PrepareSimPass(print_line_trace=False)
    for create in (prepare.create_sim_eval_comb, prepare.create_sim_tick, prepare.create_sim_reset):
        create(top)


def _indented(lines: Iterable[str], by: int) -> str:
    return "\n".join(" " * by + line for line in [*lines, "pass"])


class _Code:
    """Source of guarded calls, and the scope of its names. pure: all blocks so far have their state in signals."""

    def __init__(self, top: Any) -> None:
        self.reads = {**top.get_all_upblk_metadata()[0], **top._dag.genblk_reads}
        self.nets, self.hosts = top._dag.genblks, top._dsl.all_upblk_hostobj
        self.objects = {signal: kept[-1] for signal, kept in top._sim.signal_object_mapping.items()}
        self.scope: dict[str, Any] = {}
        self.names: dict[int, str] = {}
        self.pure = True

    def guarded(self, block: Block, after: str = "pass") -> list[str]:
        """Return lines that call ``block`` if its inputs have changed, then do ``after``."""
        if block in self.nets and not block.__code__.co_names:
            return []  # a net of whole signals: they are one object
        name = self.name(block)
        loop = block.__name__.startswith(LOOP)
        blocks = block.__globals__["scc_tick_func"].__closure__[0].cell_contents if loop else [block]
        if not all(b in self.nets or type(self.hosts[b]).__module__.endswith(OF_SIGNALS) for b in blocks):
            self.pure = False
            return [f"{name}()", after]
        values = self.values({signal for b in blocks for signal in self.reads.get(b, ())})
        self.scope[f"seen_{name}"] = None
        return [
            f"global seen_{name}",
            f"now = {values}",
            f"if now != seen_{name}:",
            f"  {name}()",
            f"  seen_{name} = {values if loop else 'now'}",
            f"  {after}",
        ]

    def values(self, signals: Iterable[Any]) -> str:
        """Return the source of a tuple of the signals' values."""
        leaves = {self.name(leaf): None for signal in sorted(signals, key=repr) for leaf in self.leaves(signal)}
        return f"({''.join(f'{leaf}._uint, ' for leaf in leaves)})"

    def leaves(self, signal: Any) -> list[Bits]:
        """Return the Bits that hold a signal, a field of it, or the base of a slice."""
        if signal.is_sliced_signal():
            signal = signal.get_parent_object()
        whole = signal.get_top_level_signal()
        return _bits(eval(f"whole{repr(signal)[len(repr(whole)) :]}", {"whole": self.objects[whole]}))

    def name(self, value: Any) -> str:
        """Return the name of ``value`` in the scope."""
        name = self.names.setdefault(id(value), f"x{len(self.names)}")
        self.scope[name] = value
        return name


def _bits(value: Any) -> list[Bits]:
    if isinstance(value, Bits):
        return [value]
    parts = value if isinstance(value, list) else (getattr(value, name) for name in value.__bitstruct_fields__)
    return [bits for part in parts for bits in _bits(part)]
