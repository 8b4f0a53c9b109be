"""The Decoder alone against the golden instructions."""

from hypothesis import given, settings
from hypothesis import strategies as st

from talbot.rtl.proc.decoder_rtl import ALU, BRANCH, CHANNEL, HALT, JUMP, LOAD, STORE, SUM, Decoder
from talbot.rtl.proc.isa import (
    BRANCHES,
    FROM_MANAGER,
    IMMEDIATE,
    LOADS,
    MASK,
    REGISTER,
    SHIFTS,
    STORES,
    TABLE,
    decode,
    encode,
)
from talbot.rtl.proc.test.isa_test import instructions
from talbot.rtl.proc.test.proc_bench import simulator

KINDS = dict.fromkeys((*REGISTER, *IMMEDIATE, *SHIFTS), ALU) | dict.fromkeys(("lui", "auipc", "fence"), SUM)
KINDS |= dict.fromkeys(LOADS, LOAD) | dict.fromkeys(STORES, STORE) | dict.fromkeys(BRANCHES, BRANCH)
KINDS |= {"jal": JUMP, "jalr": JUMP, "csrw": CHANNEL}
READS = {"R": (1, 1), "S": (1, 1), "B": (1, 1), "I": (1, 0), "H": (1, 0), "W": (1, 0)}  # by format: rs1, rs2
words = st.integers(0, MASK)
any_word = st.one_of(
    words,
    instructions().map(lambda instruction: encode(instruction[0], **instruction[1])),
    st.tuples(instructions(), st.integers(0, 31)).map(lambda pair: encode(pair[0][0], **pair[0][1]) ^ 1 << pair[1]),
)


@settings(max_examples=600, deadline=None)
@given(any_word, words)
def test_decoder(word, hart_id):
    """Every field of any instruction; a word that is none, or one bit away from one, too."""
    sim = simulator(Decoder)
    sim.word @= word
    sim.hart_id @= hart_id
    sim.sim_eval_combinational()
    control, golden = sim.control, decode(word)
    if golden is None:
        assert control.kind == HALT
        return
    name = golden.name
    form, _, funct3, funct7 = TABLE[name]
    of_manager = form == "C" and golden.imm == FROM_MANAGER
    assert control.kind == (CHANNEL if of_manager else SUM if form == "C" else KINDS[name])
    assert (sim.uses_rs1, sim.uses_rs2) == (READS.get(form, (0, 0)) if name != "fence" else (0, 0))
    assert control.writes == (golden.rd != 0 and form not in "SBW" and name != "fence")
    assert control.from_pc == (name in ("auipc", "jal", *BRANCHES))
    assert control.from_rs1 == (name in ("jalr", *LOADS, *STORES))
    if form not in "RHCW" and name != "fence":
        assert sim.imm == golden.imm & MASK
    elif form == "H":
        assert sim.imm[0:5] == golden.imm
    elif form == "C" and not of_manager:
        assert sim.imm == hart_id
    if control.kind == ALU:
        assert control.immediate == (form != "R") and control.alternative == (funct7 == 0x20)
    if control.kind in (ALU, LOAD, STORE, BRANCH, CHANNEL):
        assert control.funct3 == funct3
