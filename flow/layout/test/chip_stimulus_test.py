"""The stimulus of the whole chip: recorded in the chip that is laid out."""

import pytest

from talbot.flow.layout.chain import CHIP_TILES, input_files
from talbot.flow.layout.design import DESIGNS
from talbot.flow.layout.options import Options
from talbot.flow.layout.steps.stimulus import Stimulus, StimulusParameters


@pytest.mark.needs("yosys", "iverilog")
@pytest.mark.slow
def test_the_chip_is_watched_as_it_is_laid_out(tmp_path):
    """A trace of a chip of another size is none of this one: its header says another."""
    given = input_files(DESIGNS["asp_chip"], Options(), tmp_path)
    step = Stimulus(StimulusParameters("AspChip", "asp_chip", (), CHIP_TILES))
    found = step.run(
        {name: given[source] for name, source in step.inputs.items()},
        {name: tmp_path / file for name, file in step.outputs.items()},
    )
    assert found["source"] == "frame" and found["cycles"] > 10_000
