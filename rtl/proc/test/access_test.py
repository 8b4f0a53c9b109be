"""The lanes of a memory's word alone against the golden instructions."""

from itertools import product

from hypothesis import given, settings
from hypothesis import strategies as st

from talbot.rtl.proc.access_rtl import LoadLanes, StoreLanes
from talbot.rtl.proc.isa import LOADS, MASK, STORES, lanes, loaded
from talbot.rtl.proc.test.proc_bench import simulator


@settings(max_examples=40, deadline=None)
@given(st.integers(0, MASK))
def test_lanes(word):
    """Every size at every address: strobe and data of a store, the register of a load."""
    store, load = simulator(StoreLanes), simulator(LoadLanes)
    for name, low in product((*STORES, *LOADS), range(4)):
        funct3, golden = (LOADS | STORES)[name], lanes(name, low, word)
        store.size @= funct3 & 3
        store.low @= low
        store.data @= word
        store.sim_eval_combinational()
        assert store.misaligned == (golden is None)
        if name in STORES and golden:
            assert (store.strobe, store.word) == golden
        elif golden:
            load.funct3 @= funct3
            load.low @= low
            load.word @= word
            load.sim_eval_combinational()
            assert load.data == loaded(name, low, word)
