"""The search on a task that costs nothing: budgets, seeds, workers, resumption, trouble; real frames by every task."""

import contextlib
import json
import math
import os
import re
import signal
import sqlite3
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import optuna
import pytest
from joblib.externals.loky import get_reusable_executor

from talbot.base.page.check import faults
from talbot.base.table import read_csv
from talbot.commands import main
from talbot.imaging.explore import budget, costs, space
from talbot.imaging.explore.pool import Failure, Pool
from talbot.imaging.explore.recognition import Recognition
from talbot.imaging.explore.robust import robustness
from talbot.imaging.explore.search import Plan, dominated_share, importances, oriented, sampler_of, search, undominated
from talbot.imaging.explore.space import TILES, narrowed, point_of, tile_of
from talbot.imaging.explore.store import Store
from talbot.imaging.explore.task import FIGURES, FULL, SMALL, Fidelity, golden
from talbot.imaging.explore.tasks import SCENES, task_of
from talbot.imaging.frame.request import request
from talbot.models.parameters import STANDARD, ParameterError, read_sensor

OWN = str(Path(__file__).with_name("own.py"))
OBJECTIVES = "error", "energy_uj"


@pytest.fixture(scope="module", autouse=True)
def folder_of_trouble(tmp_path_factory):
    """Known to the processes of all searches here: they stay from one to the next."""
    with pytest.MonkeyPatch.context() as patch:
        folder = tmp_path_factory.mktemp("trouble")
        patch.setenv("TROUBLE", str(folder))
        get_reusable_executor().shutdown(kill_workers=True)
        yield folder
    get_reusable_executor().shutdown(kill_workers=True)


@pytest.fixture
def trouble(folder_of_trouble):
    """The folder, without what an earlier test put there."""
    for file in folder_of_trouble.iterdir():
        file.unlink()
    yield folder_of_trouble
    for file in folder_of_trouble.iterdir():
        file.unlink()


def plan(**more):
    task = task_of(OWN)
    return Plan(**{"task": task, "space": task.space, "objectives": OBJECTIVES, "trials": 12, "batch": 4} | more)


def facts(findings):
    """What two runs must have in common."""
    return [(row.number, row.values, row.status, row.front, row.best and row.best["figures"]) for row in findings.rows]


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """A search of 12 points, its store, and the folder of it."""
    folder = tmp_path_factory.mktemp("whole")
    return search(plan(), folder / "s.sqlite"), folder


@pytest.mark.parametrize(
    "text, said",
    [
        ("energy_uj<", "budget = 'energy_uj<': must be a figure, <, <=, > or >=, and a number"),
        ("energy<20", "budget = 'energy<20': energy must be a figure of the task; did you mean energy_uj?"),
        ("error<1,area_mm2<ten", "budget = 'area_mm2<ten': ten must be a finite number"),
        ("error<nan", "nan must be a finite number"),
        ("error<1,,bytes<2", "budget = '': must be a figure"),
    ],
)
def test_a_budget_names_the_term_that_is_wrong(text, said):
    with pytest.raises(ParameterError, match=re.escape(said)):
        budget.limits_of(text, FIGURES)


def test_limits():
    limits = budget.limits_of("energy_uj<20, frames_per_s >= 30", FIGURES)
    assert [str(limit) for limit in limits] == ["energy_uj<=20", "frames_per_s>=30"]
    assert budget.broken(limits, {"energy_uj": 19, "frames_per_s": 30}) == ""
    assert budget.broken(limits, {"energy_uj": 19, "frames_per_s": 15}) == "frames_per_s = 15: must be at least 30"
    assert [limit.excess({"energy_uj": 30, "frames_per_s": 15}) for limit in limits] == [0.5, 0.5]


def test_values_make_a_sensor():
    task = task_of("edges")
    point = point_of(task.thesis | {"chip.f_clk": 10e6, "exposure": 1.0}, STANDARD)
    assert point.sensor.tile == STANDARD.tile and point.sensor.chip == STANDARD.chip
    assert point.sensor.array.pitch == pytest.approx(STANDARD.array.pitch) and point.settings["threshold"] == 10
    half = point_of({"array.rows": 192}, STANDARD).sensor
    assert half.shape == (192, 192) and half.array.pitch == pytest.approx(20e-6)
    smaller = point_of({"array.rows": 192, "array.pitch": 10e-6}, STANDARD).sensor
    assert smaller.optics.camera.focal_length == pytest.approx(STANDARD.optics.camera.focal_length / 2)
    for text in TILES:
        tile = tile_of(text)
        assert {kind.beta for kind in tile.types} == {float(beta) for beta in text.split("/")[0].split("+")}
        assert tile.n_types == len(set(tile.types))


@pytest.mark.parametrize(
    "text, said",
    [
        ("chip.lane", "keys = 'chip.lane': must be a key of the task; did you mean chip.lanes?"),
        ("chip.lanes=3", "keys = chip.lanes=3: must be of 1,2,4,8"),
        ("threshold=1..20", "keys threshold = '1': must be a number in [2, 40]"),
        ("threshold=4.5..20", "must be whole numbers"),
        ("threshold=20..4", "must not be inverted"),
    ],
)
def test_keys_that_are_refused(text, said):
    with pytest.raises(ParameterError, match=re.escape(said)):
        narrowed(task_of(OWN).space, text)


def test_keys():
    space = narrowed(task_of(OWN).space, "threshold=4..20 chip.lanes=1,8 gain")
    assert space == {"threshold": (4, 20), "chip.lanes": [1, 8], "gain": (0.5, 2.0)}
    assert narrowed(task_of(OWN).space, "threshold=4,20")["threshold"] == [4, 20]


@pytest.mark.parametrize(
    "words, said",
    [
        ("--task none.py", "task = 'none.py': no such file"),
        ("--task edge", "task = 'edge': must be one of edges, lightfield"),
        ("--task OWN --scenes coins", "scenes = 'coins': must be left out"),
        ("--task OWN --objectives error,sharp", "objectives = 'sharp': must be one of error, energy_uj"),
        ("--task OWN --objectives error,error", "must be different"),
        ("--task OWN --sampler best", "sampler = 'best': must be one of tpe, nsga, random"),
        ("--task OWN --sampler random --baseline", "sampler = 'random': must be another with a baseline"),
        ("--task OWN --trials 0", "trials = '0': must be an integer in 1..1000000"),
        ("--task recognition --scenes a,b", "must be one set of pictures"),
    ],
)
def test_refused_in_one_line_before_anything_is_written(words, said, tmp_path, capsys):
    arguments = [OWN if word == "OWN" else word for word in words.split()]  # the checkout's path may hold a space
    assert main(["explore", *arguments, "--out", str(tmp_path / "out")]) == 2
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 1 and said in lines[0] and not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    "text, said",
    [
        ("SPACE = {}\ndef evaluate(p, f, s): ...", "SPACE = {}: must be a dict"),
        ("SPACE = {'array.row': [1]}\ndef evaluate(p, f, s): ...", "did you mean array.rows?"),
        ("SPACE = {'threshold': 7}\ndef evaluate(p, f, s): ...", "must be a list of choices, or (low, high)"),
        ("SPACE = {'threshold': (1, 7)}", "must have a function evaluate(point, fidelity, seed)"),
        ("1 / 0", "ZeroDivisionError: division by zero"),
    ],
)
def test_a_file_that_is_no_task(text, said, tmp_path):
    (tmp_path / "mine.py").write_text(text)
    with pytest.raises(ParameterError, match=re.escape(said)):
        task_of(str(tmp_path / "mine.py"))


def test_the_front(whole):
    findings, _ = whole
    full = [row for row in findings.rows if row.full]
    assert len(findings.rows) == 12 and findings.front and all(row.full for row in findings.front)
    for row in full:
        beaten = [
            other
            for other in full
            if all(other.full["figures"][name] <= row.full["figures"][name] for name in OBJECTIVES)
            and any(other.full["figures"][name] < row.full["figures"][name] for name in OBJECTIVES)
        ]
        assert row.front == (not beaten)
    small = [row for row in findings.rows if row.status == "small"]
    assert small, "every point was evaluated in full"
    for row in small:  # what is not evaluated in full is beaten in the small scene
        assert any(
            all(other.small["figures"][name] <= row.small["figures"][name] for name in OBJECTIVES) for other in full
        )
    assert findings.thesis.full["figures"]["error"] == pytest.approx(7 / 40 + 4 / 48 + 0.01)


@pytest.mark.slow
def test_workers_do_not_change_results_and_seeds_do(whole, tmp_path):
    findings, _ = whole
    assert facts(search(plan(workers=2), tmp_path / "two.sqlite")) == facts(findings)
    assert facts(search(plan(seed=2), tmp_path / "other.sqlite")) != facts(findings)


def test_a_search_continues_with_the_same_points(whole, tmp_path, trouble):
    findings, folder = whole
    path = tmp_path / "s.sqlite"
    search(plan(trials=6), path)
    first = len((trouble / "log").read_text().split())
    assert facts(search(plan(), path)) == facts(search(plan(), path)) == facts(findings)
    every = len((trouble / "log").read_text().split())
    assert 0 < first < every == 1 + sum(2 if row.full else 1 for row in findings.rows)


@pytest.mark.parametrize("sampler", ["nsga", "random"])
def test_other_samplers(sampler, tmp_path):
    findings = search(plan(sampler=sampler, trials=8, multi=False, thesis=False), tmp_path / "s.sqlite")
    assert findings.thesis is None
    assert len(findings.rows) == 8 and all(row.status == "full" for row in findings.rows) and findings.front


def test_random_points_are_a_baseline_in_the_same_box(tmp_path, capsys):
    words = ["--objectives", "error,energy_uj", "--trials", "8", "--batch", "4", "--no-thesis", "--baseline"]
    assert main(["explore", "--task", OWN, *words, "--out", str(tmp_path)]) == 0
    by_search, by_chance = map(float, re.search(r"tpe ([\d.]+) %, random ([\d.]+) %", capsys.readouterr().out).groups())
    assert 0 < by_search <= 100 and 0 < by_chance <= 100


def test_a_baseline_without_a_point_has_no_share(tmp_path, trouble, capsys):
    words = ["--budget", "area_mm2<1", "--trials", "4", "--no-thesis", "--baseline"]
    assert main(["explore", "--task", OWN, *words, "--out", str(tmp_path)]) == 0
    assert "dominated" not in capsys.readouterr().out


def test_settings_of_no_effect_make_no_other_point():
    task = Recognition()
    image, edges = ({"front": front, "scale": 3, "blur": 1.0, "threshold": 8} for front in ("image", "asp"))
    assert task.effective(image) == task.effective(image | {"scale": 5, "threshold": 20}) == {"front": "image"}
    assert task.effective(edges) == edges


def test_a_budget_that_no_sensor_keeps_is_refused_before_any_evaluation(tmp_path, trouble):
    limits = budget.limits_of("area_mm2<1", FIGURES)
    findings = search(plan(limits=limits), tmp_path / "s.sqlite")
    assert findings.exhausted and not findings.rows and findings.refused["area_mm2"] > 100
    assert len((trouble / "log").read_text().split()) == 1  # the thesis's


def test_a_budget_holds_on_the_front(tmp_path):
    limits = budget.limits_of("energy_uj<45", FIGURES)
    findings = search(plan(limits=limits), tmp_path / "s.sqlite")
    assert findings.front and all(row.full["figures"]["energy_uj"] <= 45 for row in findings.front)


def test_a_limit_of_the_error_counts_in_full_alone(tmp_path, whole):
    """The small scene of this task has a larger error, by which no point would have kept the limit."""
    least = min(row.full["figures"]["error"] for row in whole[0].front)
    limits = budget.limits_of(f"error<{least + 0.01}", FIGURES)
    findings = search(plan(limits=limits), tmp_path / "s.sqlite")
    assert findings.front and all(
        row.full["figures"]["error"] <= least + 0.01 < row.small["figures"]["error"] for row in findings.front
    )


@pytest.mark.parametrize(
    "kind, said",
    [
        ("raise", "RuntimeError: trouble at"),
        pytest.param("die", "its process died", marks=pytest.mark.slow),
        pytest.param("hang", "timeout: longer than 10 s", marks=pytest.mark.slow),
        ("refuse", "must be another"),
    ],
)
def test_trouble_is_reported_and_no_other_trial_is_lost(kind, said, tmp_path, trouble, whole):
    findings, _ = whole
    bad = findings.rows[2].values["threshold"]
    (trouble / str(bad)).write_text(kind)
    again = search(plan(trials=4, seconds=10.0, workers=2), tmp_path / "s.sqlite")
    assert [row.values for row in again.rows] == [row.values for row in findings.rows[:4]]
    for row in again.rows:
        if row.values["threshold"] == bad:
            assert row.status == ("refused" if kind == "refuse" else "failed") and said in row.reason
        else:
            assert row.status in ("small", "full")


def test_what_dies_once_is_tried_again(tmp_path, trouble, whole):
    findings, _ = whole
    (trouble / str(findings.rows[1].values["threshold"])).write_text("once die")
    assert facts(search(plan(), tmp_path / "s.sqlite")) == facts(findings)


def test_a_store_that_is_damaged_is_named(tmp_path):
    path = tmp_path / "s.sqlite"
    store = Store(path, "a", ["minimize"])
    for k in range(3):
        spaces = {"k": optuna.distributions.IntDistribution(0, 9)}
        store.add("small", {"k": k}, spaces, [1.0], {"figures": {"error": 1.0}})
    store.close()
    data, page = path.read_bytes(), bytes(4096)
    record = data.rindex(b'"figures"')
    for damaged in (data[:99999], data[:4096] + page + data[8192:], data[:record] + data[record + 1 :]):
        path.write_bytes(damaged)
        with pytest.raises(ParameterError, match=r"^store = '.*s.sqlite': must be a file of talbot explore \(\w+\)$"):
            Store(path, "a", ["minimize"]).records()


def test_a_full_disk_is_told_and_leaves_the_store_whole(tmp_path, monkeypatch):
    path = tmp_path / "s.sqlite"
    store = Store(path, "a", ["minimize"])
    from optuna.distributions import IntDistribution

    spaces = {"k": IntDistribution(0, 100)}
    store.add("small", {"k": 1}, spaces, [1.0], {"figures": {"error": 1.0}})
    from sqlalchemy import event

    @event.listens_for(store._storage.engine, "begin")
    def _(connection):
        connection.exec_driver_sql("PRAGMA max_page_count = 1")  # SQLite does not go below what there is

    with pytest.raises(OSError, match="No space left"):
        for k in range(2, 100):
            store.add("small", {"k": k}, spaces, [1.0], {"picture": "x" * 20000})
    store.close()
    with contextlib.closing(sqlite3.connect(path)) as base:
        assert base.execute("PRAGMA integrity_check").fetchone() == ("ok",)
    store = Store(path, "a", ["minimize"])
    assert ("small", '{"k": 1}') in store.records()
    store.close()


def test_a_store_that_is_none(tmp_path):
    (tmp_path / "s.sqlite").write_text("not a database, " * 100)
    with pytest.raises(ParameterError, match="must be a file of talbot explore"):
        Store(tmp_path / "s.sqlite", "a", ["minimize"])


def test_a_kill_and_the_same_front(tmp_path, whole):
    findings, _ = whole
    words = [sys.executable, "-m", "talbot", "explore", "--task", OWN, "--trials", "12", "--batch", "4"]
    words += ["--objectives", ",".join(OBJECTIVES), "--out", str(tmp_path / "out")]
    child = subprocess.Popen(words, stderr=subprocess.PIPE, text=True, start_new_session=True)
    until = time.monotonic() + 300
    while time.monotonic() < until and child.poll() is None:
        store = tmp_path / "out" / "trials.sqlite"
        if store.exists() and _count(store) > 2:
            break
        time.sleep(0.05)
    os.killpg(child.pid, signal.SIGKILL)
    child.communicate()
    names = {path.name for path in (tmp_path / "out").iterdir() if not path.name.startswith(".part")}
    assert names <= {"trials.sqlite", "trials.sqlite-journal"} or (tmp_path / "out" / "summary.json").exists()
    assert main(words[3:]) == 0
    rows = read_csv(tmp_path / "out" / "trials.csv")[1:]
    assert [row["front"] for row in rows] == [str(row.front) for row in findings.rows]
    assert [row["gain"] for row in rows] == pytest.approx([row.values["gain"] for row in findings.rows], rel=1e-5)


def _count(store):
    try:
        with contextlib.closing(sqlite3.connect(f"file:{store}?mode=ro", uri=True)) as base:
            return base.execute("select count(*) from trials").fetchone()[0]
    except sqlite3.OperationalError:
        return 0


def test_files_of_a_run(tmp_path, capsys):
    out, words = tmp_path / "out", ["--objectives", ",".join(OBJECTIVES), "--trials", "8", "--batch", "4"]
    assert main(["explore", "--task", OWN, *words, "--robust", "2", "--out", str(out)]) == 0
    s = json.loads((out / "summary.json").read_text())
    assert {path.name for path in out.iterdir()} == {
        "explore.html",
        "points",
        "summary.json",
        "trials.csv",
        "trials.sqlite",
    }
    assert s["front"] and s["provenance"]["packages"]["optuna"] and s["provenance"]["search"]
    for entry in [s["thesis"], *s["front"]]:
        sensor = read_sensor(out / "points" / f"{entry['point']}.toml")
        assert sensor.array.rows == entry["values"]["array.rows"] and sensor.chip.lanes == entry["values"]["chip.lanes"]
        assert f"SENSOR={out}/points/{entry['point']}.toml" in entry["command"]
    assert s["robustness"]["yield"] is not None and len(s["robustness"]["cases"]) == 8
    assert s["convergence"][-1]["trials"] == 8 and 0 < s["convergence"][-1]["share"] < 1
    text = (out / "explore.html").read_text()
    ours = re.sub(r"<script>/\*\*.*?</script>", "", text, count=1, flags=re.DOTALL)
    assert len(text) > 4e6 > 1e6 > len(ours) and not faults(ours)
    assert "look at" in capsys.readouterr().out


def test_a_table_goes_into_a_document(tmp_path):
    document = tmp_path / "front.md"
    document.write_text("before\n<!-- own error,energy_uj -->\n<!-- end of own error,energy_uj -->\n")
    words = ["--objectives", "error,energy_uj", "--trials", "4", "--document", str(document)]
    assert main(["explore", "--task", OWN, *words, "--out", str(tmp_path / "out")]) == 0
    assert "| point | error | energy_uj |" in document.read_text()


def test_processes_that_were_killed_while_they_waited_are_replaced():
    with Pool(1) as pool:
        assert list(pool.run(math.sqrt, [(4,)])) == [(0, 2.0)]
        for process in [*pool._executor._processes]:
            os.kill(process, signal.SIGKILL)
        assert list(pool.run(math.sqrt, [(9,)])) == [(0, 3.0)]


@pytest.mark.slow
def test_dask_runs_the_same_trials(whole, tmp_path, monkeypatch):
    import distributed

    findings, _ = whole
    monkeypatch.setenv("PYTHONHASHSEED", "0")  # a cluster sets it for its workers, and leaves it
    with (
        distributed.LocalCluster(n_workers=1, threads_per_worker=1, processes=True, dashboard_address=None) as cluster,
        monkeypatch.context() as patch,
    ):
        patch.setenv("SCHEDULER", cluster.scheduler_address)
        assert facts(search(plan(), tmp_path / "s.sqlite")) == facts(findings)


def test_a_scheduler_that_is_none(monkeypatch):
    monkeypatch.setenv("SCHEDULER", "nonsense://nowhere")
    with pytest.raises(ParameterError, match="SCHEDULER = 'nonsense://nowhere'"), Pool():
        pass


def test_undominated_points_and_the_share_that_they_dominate():
    points = oriented(
        [{"error": 1, "frames_per_s": 1}, {"error": 2, "frames_per_s": 3}, {"error": 3, "frames_per_s": 2}],
        ("error", "frames_per_s"),
    )
    assert undominated(points).tolist() == [True, True, False]
    assert dominated_share(np.array([[0.5, 0.5]]), [0, 0], [1, 1]) == pytest.approx(0.25, abs=0.01)
    assert undominated(np.ones((3, 2))).all()


def test_importances_find_the_key_that_counts(tmp_path):
    findings = search(plan(trials=40, multi=False), tmp_path / "s.sqlite")
    worth = importances(findings, "bytes")
    assert max(worth, key=worth.get) in ("threshold", "array.rows") and sum(worth.values()) == pytest.approx(1)


VALUES = {"array.rows": 96, "chip.lanes": 4, "tile.types": "12+24/2", "exposure": 0.5, "chip.f_clk": 10e6}
POINTS = {
    "edges": VALUES | {"threshold": 10, "optics.camera.f_number": 1.2, "electrical.difference_gain": 4.0},
    "lightfield": VALUES,
    "polarization": {"array.rows": 96, "chip.lanes": 4, "tile.types": TILES[-1], "exposure": 0.5},
    "depth": {
        "array.rows": 48,
        "chip.lanes": 4,
        "electrical.f_mod": 30e6,
        "electrical.white_current": 0.25e-9,
        "optics.camera.f_number": 1.2,
        "method": "field",
    },
    "recognition": {"front": "asp", "scale": 3, "blur": 4.0, "threshold": 8, "tile.types": "12+24/2", "chip.lanes": 4},
}
QUICK = Fidelity("quick", 1.0, 3)


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=() if name in ("edges", "recognition") else pytest.mark.slow) for name in SCENES]
)
def test_every_task_beats_what_costs_nothing(name, monkeypatch):
    task = task_of(name)
    if name == "recognition":
        monkeypatch.setattr(Recognition, "SOME", 120)
    point = point_of(POINTS[name], task.base)
    point = replace(point, sensor=task.sensor(point))
    outcome = task.evaluate(point, SMALL if name == "recognition" else QUICK, 1)
    least = costs.least(task.requests(point))
    assert {*FIGURES, *task.extra} == outcome.figures.keys() | {"area_mm2"}
    assert all(np.isfinite(value) for value in outcome.figures.values())
    assert outcome.figures["error"] < task.free_error() and np.ndim(outcome.picture) == 2
    assert outcome.figures["energy_uj"] >= least["energy_uj"] and outcome.figures["bytes"] >= least["bytes"]
    assert set(POINTS[name]) <= set(task.space) and task.words(point).startswith("make ")


@pytest.mark.slow
def test_the_divider_sends_less_than_the_depth_field():
    task = task_of("depth")
    values = POINTS["depth"] | {"electrical.f_mod": 100e6}  # a turn of 1.5 m, in a scene of 2.4 m
    points = [point_of(values | {"method": method}, task.base) for method in ("divider", "field")]
    divider, field = (task.evaluate(point, SMALL, 1).figures for point in points)
    assert divider["bytes"] < field["bytes"] / 2 and field["error"] < divider["error"]
    assert divider["light_uj"] == field["light_uj"] > 0


def test_a_point_is_the_frame_of_its_sensor():
    """As talbot.Sensor recomputes it: the same bytes, with the settings of its command."""
    point = point_of(POINTS["edges"], STANDARD)
    frame = golden(point, FULL, 1, "coins", "edge", threshold=4, exposure=0.5)
    lead = frame.whole.frame.timing.exposure
    same = request(sensor=point.sensor, scene="coins", mode="edge", threshold=4, exposure=lead)
    from talbot.imaging.frame.job import golden_result

    assert golden_result(same).stream == frame.result.stream and SMALL.part < FULL.part


def test_the_command_of_a_point_has_its_exposure():
    task, point = task_of("edges"), point_of(POINTS["edges"], STANDARD)
    lead = task.requests(point)[0].frame.timing.exposure
    assert task.words(point) == f"make sim SCENE=motorcycle MODE=edge LUX=500 THRESHOLD=10 EXPOSURE={lead}"
    bright = task_of("edges", lux=5e5)  # t_int alone is long enough: the command is to choose it, too
    assert not bright.requests(point)[0].frame.timing.exposure and bright.words(point).endswith("THRESHOLD=10")


def test_a_pool_gives_every_result_or_failure():
    with Pool(2, 60.0) as pool:
        results = dict(pool.run(divmod, [(7, 2), (1, 0), (9, 4)]))
    assert results[0] == (3, 1) and results[2] == (2, 1)
    assert (
        results[1] == Failure("ZeroDivisionError: integer division or modulo by zero")
        or "ZeroDivision" in results[1].reason
    )


def test_a_batch_has_its_seed():
    one, same, other = (sampler_of(plan(sampler="random"), number)._rng.rng.random() for number in (3, 3, 4))
    assert one == same != other
    assert robustness.__doc__ and space.check_space
