"""The table at the end of `make layout`: the worst corner, what was not run, what is broken."""

from pathlib import Path

from talbot.flow.layout.report.metrics import broken
from talbot.flow.layout.report.page import closing

NONE = ("utilization", "cells", "f_max_mhz", "equivalence")
SUMMARY = {"area_um2": 1234.5, "open_nets": 0, "drc_violations": 2, "lvs_match": True, "antenna_violations": 0}
SUMMARY |= {"gate_tests": {"passed": 3, "failed": 0}, "wns_ns": {"tt": 0.5, "ss": -0.25}}
SUMMARY |= {"leakage_uw": {"tt": 1.5, "ss": 4800.0}, **dict.fromkeys(NONE)}


def test_closing():
    rules = {"drc_violations": {"is": 0}, "wns_ns": {"least": 0}, "lvs_match": {"is": True}}
    lines = closing(SUMMARY, broken(SUMMARY, rules), Path("out/report.html")).splitlines()
    found = {line[2:30].strip(): line[30:] for line in lines}
    assert found["setup slack, ss"] == "-0.250 ns" and found["hold slack"] == found["equivalence"] == "not run"
    assert found["leakage, ss"] == "4,800.0 uW"
    assert (found["area"], found["LVS"], found["DRC violations"]) == ("1,234 um2", "match", "2")
    assert (found["limits"], found["look at"]) == ("2 broken", "out/report.html")


def test_closing_without_a_layout():
    lines = closing(SUMMARY | {"area_um2": None}, ["open_nets = None: must be 0"], Path("report.html")).splitlines()
    assert lines[0].split() == ["area", "not", "run"]
