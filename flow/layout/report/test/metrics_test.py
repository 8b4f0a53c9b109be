"""Limits: a value in, at and beyond them, and one that was never measured."""

import pytest

from talbot.flow.layout.report.metrics import broken

GOOD = {
    "design": "a",
    "open_nets": 0,
    "lvs_match": True,
    "gate_tests": {"passed": 3},
    "whs_ns": {"tt": 0.1, "ff": -0.2},
}


@pytest.mark.parametrize(
    "rules, found",
    [
        ({"open_nets": {"is": 0}, "lvs_match": {"is": True}}, []),
        ({"gate_tests.passed": {"least": 3, "most": 3}}, []),
        ({"gate_tests.passed": {"least": 4}}, ["gate_tests.passed = 3: must be at least 4"]),
        ({"gate_tests.passed": {"most": 2}}, ["gate_tests.passed = 3: must be at most 2"]),
        ({"drc": {"is": 0, "unless": "lvs_match"}}, []),
        ({"drc": {"is": 0, "unless": "user_verilog"}}, ["drc = None: must be 0"]),
        ({"lvs_match": {"is": False}}, ["lvs_match = True: must be False"]),
        ({"wns_ns": {"least": 0}}, ["wns_ns = None: must be at least 0"]),
        ({"wns_ns": {"least": 0, "if_measured": True}}, []),
        ({"whs_ns": {"least": 0, "if_measured": True}}, ["whs_ns = {'tt': 0.1, 'ff': -0.2}: must be at least 0"]),
    ],
)
def test_rules(rules, found):
    assert broken(GOOD, rules) == found
