"""Random programs that stop: instructions of every kind, dependent on each other, around data at DATA."""

from hypothesis import strategies as st

from talbot.rtl.proc.isa import (
    BRANCHES,
    EBREAK,
    FROM_MANAGER,
    HART_ID,
    IMMEDIATE,
    LOADS,
    REGISTER,
    SHIFTS,
    STORES,
    TO_MANAGER,
    encode,
)

DATA, DUMP = 0x700, 0x600  # the data's middle; where the registers are stored at the end
BASE, COUNT, SCRATCH = 1, 2, 3  # registers: DATA; of loops; of addresses
USED = (*range(4, 10), 15, 20, 21, 31)  # few registers: most instructions depend on those before
FREE = st.sampled_from((0, *USED))
ACCESSES = st.sampled_from([*LOADS, *STORES])
IMM = st.sampled_from((0, 1, -1, 4, 31, 2047, -2048)) | st.integers(-2048, 2047)


def _access(name, register, offset, scratch):
    """Return the words of a load or store near DATA, with an address that depends on ``scratch`` unless it is 0."""
    size = 1 << ((LOADS | STORES)[name] & 3)
    fields = {"rd" if name in LOADS else "rs2": register, "imm": offset // size * size}
    if not scratch:
        return [encode(name, rs1=BASE, **fields)]
    index = encode("andi", SCRATCH, scratch, imm=0x7C)
    return [index, encode("add", SCRATCH, SCRATCH, BASE), encode(name, rs1=SCRATCH, **fields)]


def _far(name, register, offset, page):
    """Return the words of a load or store anywhere above the program and its data."""
    size = 1 << ((LOADS | STORES)[name] & 3)
    fields = {"rd" if name in LOADS else "rs2": register, "imm": offset // size * size}
    return [encode("lui", SCRATCH, imm=page), encode(name, rs1=SCRATCH, **fields)]


NEAR = st.builds(_access, ACCESSES, FREE, st.integers(-128, 124), FREE)
ITEMS = st.one_of(
    st.builds(lambda n, d, a, b: [encode(n, d, a, b)], st.sampled_from([*REGISTER]), FREE, FREE, FREE),
    st.builds(lambda n, d, a, i: [encode(n, d, a, imm=i)], st.sampled_from([*IMMEDIATE]), FREE, FREE, IMM),
    st.builds(lambda n, d, a, i: [encode(n, d, a, imm=i)], st.sampled_from([*SHIFTS]), FREE, FREE, st.integers(0, 31)),
    st.builds(
        lambda n, d, i: [encode(n, d, imm=i)], st.sampled_from(("lui", "auipc")), FREE, st.integers(0, 2**20 - 1)
    ),
    NEAR,
    st.builds(lambda d: [encode("csrr", d, imm=FROM_MANAGER)], FREE),
    st.builds(lambda d: [encode("csrr", d, imm=HART_ID)], FREE),
    st.builds(lambda a: [encode("csrw", rs1=a, imm=TO_MANAGER)], FREE),
    st.just([encode("fence")]),
    # the offset is in items, see `program`
    st.tuples(st.sampled_from([*BRANCHES, "jal", "jalr", "loop"]), FREE, FREE, st.integers(1, 6)),
)
PAGES = st.sampled_from((1, 2, 2**19, 2**20 - 1)) | st.integers(1, 2**20 - 1)
FAR = st.builds(_far, ACCESSES, FREE, st.integers(-8, 8) | st.integers(-2048, 2047), PAGES)
WILD = st.one_of(  # most of them stop the processor
    st.integers(0, 2**32 - 1).map(lambda word: [word]),
    st.builds(
        lambda n, d, i: [encode(n, **{"rd" if n in LOADS else "rs2": d}, rs1=BASE, imm=i)],
        ACCESSES,
        FREE,
        st.integers(-128, 127),
    ),
    st.builds(lambda n, d, i: [encode(n, rd=d, imm=2 * i)], st.just("jal"), FREE, st.integers(1, 20)),
)


def _jump(item, place, starts, end):
    """Return the words of ``item``, a jump by items at ``place``; a loop goes back."""
    name, d, a, count = item
    if name == "loop":
        here = max(0, place - count)
        return [
            encode("addi", COUNT, COUNT, imm=-1),
            encode("blt", rs1=0, rs2=COUNT, imm=4 * (starts[here] - starts[place] - 1)),
        ]
    target = starts[place + count] if place + count < len(starts) else end
    offset = 4 * (target - starts[place])
    if name == "jal":
        return [encode("jal", d, imm=offset)]
    if name == "jalr":
        return [encode("auipc", SCRATCH), encode("jalr", d, SCRATCH, imm=offset)]
    return [encode(name, rs1=d, rs2=a, imm=offset)]


def program(items, loops=3):
    """Return the program of ``items``: registers set, the items, registers stored, stop. loops: in all of them."""
    words = [encode("addi", BASE, imm=DATA), encode("addi", COUNT, imm=loops)]
    for n in USED:  # no part of a register is 0
        words += [encode("lui", n, imm=0x12345 * n & 0xFFFFF), encode("addi", n, n, imm=(0x4D3 * n & 0xFFF) - 2048)]
    lengths = [len(item) if isinstance(item, list) else 1 + (item[0] in ("jalr", "loop")) for item in items]
    starts = [len(words) + sum(lengths[:n]) for n in range(len(items))]
    end = len(words) + sum(lengths)
    for place, item in enumerate(items):
        words += item if isinstance(item, list) else _jump(item, place, starts, end)
    words += [encode("sw", rs1=0, rs2=n, imm=DUMP + 4 * n) for n in range(32)] + [EBREAK]
    return b"".join(word.to_bytes(4, "little") for word in words)


PROGRAMS = st.lists(ITEMS | FAR, max_size=60).map(program)
WILD_PROGRAMS = st.lists(ITEMS | FAR | WILD, min_size=1, max_size=30).map(program)
