"""Run history: a figure that changes is a new line, the same figures are none."""

import json

from talbot.flow.layout.report.history import Run, history, table

SUMMARY = {
    "area_um2": 10.0,
    "wns_ns": {"tt": 2.0, "ss": -1.0},
    "power_uw": {"tt": 7.0, "ff": 3.0},
    "lvs_match": True,
    "wall_s": {"drc": 2.4, "lvs": 1.0},
}


def test_runs(tmp_path):
    path = tmp_path / "history.jsonl"
    for area in (10.0, 10.0, 9.0):
        path.write_text("".join(run.line() for run in history(path, SUMMARY | {"area_um2": area})))
        path.write_bytes(path.read_bytes() + b'{"when": "2026\xff\n[]\n\n')  # damaged: left out
    path.write_text("".join(run.line() for run in history(path, SUMMARY | {"area_um2": 9.0})))
    runs = [json.loads(line) for line in path.read_text().splitlines()]
    assert [(run["area_um2"], run["wns_ns"], run["power_uw"], run["seconds"]) for run in runs] == [
        (10.0, -1.0, 7.0, 3),
        (9.0, -1.0, 7.0, 3),
    ]
    names, rows = table(list(map(Run.read, path.read_text().splitlines())), most=1)
    assert [dict(zip(names, row, strict=True))["area, um2"] for row in rows] == [("9.0", True)]
    assert dict(zip(names, rows[0], strict=True))["setup slack, ns"] == ("-1.0", False)
