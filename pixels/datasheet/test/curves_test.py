"""A tap after the first, in the bench of a column."""

from talbot.pixels.circuits import column as columns
from talbot.pixels.datasheet.curves import later_bench
from talbot.pixels.datasheet.job import column_of, setup_of


def test_the_second_tap_is_driven_and_the_first_is_at_rest():
    setup, _ = setup_of("sky130")
    spec, sizes = column_of(setup)
    (part,) = (one for one in later_bench(sizes, spec).instances if one.name == "column")
    at = dict(zip(columns.PINS, part.nodes, strict=True))
    assert [at[name] for name in ("w1", "f1", "fn1", "unasked1")] == ["w0", "f0", "fn0", "unasked0"]
    for d in ("", "_a"):  # the second diode's holder has the first tap alone
        assert [at[f"{name}{d}"] for name in ("w0", "f0", "fn0")] == ["vss", "vss", "vdd"]
    assert at["unasked0"] == at["unasked2"] == "vdd" and at["w2"] == "vss"
