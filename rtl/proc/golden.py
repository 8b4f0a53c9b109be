"""The golden processor: an instruction-set simulator, one instruction at a time."""

from collections.abc import Generator, Iterable
from dataclasses import dataclass, field

from talbot.rtl.proc.isa import (
    BRANCHES,
    FROM_MANAGER,
    HART_ID,
    LOADS,
    MASK,
    REGISTER,
    STORES,
    compute,
    decode,
    lanes,
    loaded,
    taken,
)


@dataclass(frozen=True)
class Fetch:
    """A request for the instruction at ``address``; the answer is its word."""

    address: int


@dataclass(frozen=True)
class Access:
    """A request to the data memory; the answer is the word at ``address``. strobe: bytes to write, 0 for a load."""

    strobe: int
    address: int
    data: int


@dataclass(frozen=True)
class Receive:
    """A request for the manager's next word, which is the answer."""


@dataclass(frozen=True)
class Send:
    """A ``word`` to the manager."""

    word: int


Execution = Generator[Fetch | Access | Receive | Send, int, list[int]]


def execution(hart_id: int = 0) -> Execution:
    """Yield a program's requests, from pc 0 until the processor stops; returns the registers."""
    registers, pc = [0] * 32, 0
    while True:
        op = decode((yield Fetch(pc)))
        if op is None:
            return registers
        a, b, total = registers[op.rs1], registers[op.rs2], registers[op.rs1] + op.imm & MASK
        result, following = None, pc + 4 & MASK
        if op.name in LOADS or op.name in STORES:
            access = lanes(op.name, total, b)
            if access is None:
                return registers
            word = yield Access(access[0], total & ~3, access[1])
            result = loaded(op.name, total, word) if op.name in LOADS else None
        elif op.name in BRANCHES:
            following = pc + op.imm & MASK if taken(op.name, a, b) else following
        elif op.name in ("jal", "jalr"):
            result, following = following, (pc + op.imm if op.name == "jal" else total & ~1) & MASK
        elif op.name == "csrw":
            yield Send(a)
        elif op.name == "csrr":
            result = {HART_ID: hart_id}.get(op.imm)
            result = (yield Receive()) if op.imm == FROM_MANAGER else result
        elif op.name in ("lui", "auipc"):
            result = op.imm + (pc if op.name == "auipc" else 0) & MASK
        elif op.name != "fence":
            result = compute(op.name, a, b if op.name in REGISTER else op.imm & MASK)
        if following & 3:
            return registers
        if result is not None and op.rd:
            registers[op.rd] = result
        pc = following


@dataclass
class Memory:
    """Words by address, 0 where nothing was written."""

    words: dict[int, int] = field(default_factory=dict)

    @classmethod
    def of(cls, program: bytes, base: int = 0) -> "Memory":
        """Return a memory with ``program`` at ``base``."""
        padded = program + bytes(-len(program) % 4)
        return cls({base + i: int.from_bytes(padded[i : i + 4], "little") for i in range(0, len(padded), 4)})

    def access(self, strobe: int, address: int, data: int) -> int:
        """Return the word at ``address``, then write the bytes of ``strobe``."""
        old = self.words.get(address, 0)
        if strobe:
            mask = sum(0xFF << 8 * i for i in range(4) if strobe >> i & 1)
            self.words[address] = old & ~mask | data & mask
        return old


@dataclass
class Run:
    """Result of a program. stopped: within the limit of instructions. registers: at the stop."""

    memory: Memory
    accesses: list[Access] = field(default_factory=list)
    sent: list[int] = field(default_factory=list)
    pcs: list[int] = field(default_factory=list)
    registers: list[int] = field(default_factory=list)
    stopped: bool = False


def run(program: bytes, words: Iterable[int] = (), hart_id: int = 0, limit: int = 100_000) -> Run:
    """Run ``program`` at address 0 with the manager's ``words``, until it stops, lacks a word, or the ``limit``."""
    out, words, execute = Run(Memory.of(program)), iter(words), execution(hart_id)
    request = next(execute)
    try:
        while True:
            answer = 0
            if isinstance(request, Fetch):
                if len(out.pcs) == limit:
                    return out
                out.pcs.append(request.address)
                answer = out.memory.access(0, request.address, 0)
            elif isinstance(request, Access):
                out.accesses.append(request)
                answer = out.memory.access(request.strobe, request.address, request.data)
            elif isinstance(request, Send):
                out.sent.append(request.word)
            elif (word := next(words, None)) is not None:
                answer = word
            else:
                return out
            request = execute.send(answer)
    except StopIteration as stop:
        out.registers, out.stopped = stop.value, True
        return out
