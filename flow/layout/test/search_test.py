"""The search for an area: outlines that the cells of an earlier attempt would overfill are skipped."""

import re

import pytest

from talbot.flow.layout import search
from talbot.flow.layout.design import design
from talbot.flow.layout.options import Options
from talbot.flow.layout.steps.stage import SCRIPTS

FULL = "cells fill {:.1f} % of the core after repair: must be at most 86 %"


class Places:
    """A Runner of stages that repair fills: the cells take 1.17 times their area after synthesis."""

    def __init__(self):
        self.paths, self.notes, self.floor = {}, [], None

    def run(self, step):
        if step.name == "floorplan":
            self.floor = step.parameters.floor.utilization
        filled = 117 * (self.floor or 0)
        stopped = FULL.format(filled) if step.name == "cts" and filled > 86 else None
        return {"metrics": {"stopped": stopped, "again": None, "open_nets": 0, "utilization": filled}}

    def run_all(self, steps):
        return [{"metrics": {}} for _ in steps]

    def note(self, text):
        self.notes.append(text)


def test_the_next_attempt_is_the_first_that_fits():
    tried = search._attempted(design("amp_ctrl"), Options(), Places())
    assert [attempt.asked for attempt in tried] == [0.8, 0.72] and tried[-1].rules_broken == 0


@pytest.mark.parametrize(
    ("stopped", "highest"),
    [(f"cts: {FULL.format(93.5)}", 0.8 * 86 / 93.5), ("route: detailed routing does not converge: 3 3 violations", 1)],
)
def test_a_full_core_tells_what_fits(stopped, highest):
    assert search.fitting(0.8, stopped) == pytest.approx(highest)


def test_the_script_says_so_in_these_words():
    (said,) = re.findall(r'format "(cells fill .*)" \{', (SCRIPTS / "common.tcl").read_text(encoding="utf-8"))
    assert search.FULL.fullmatch(said.replace("%.1f", "93.5").replace("%g", "86").replace("%%", "%"))
