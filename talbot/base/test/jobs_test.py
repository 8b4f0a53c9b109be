"""Jobs: results in order, each computed once, a failed run goes on from where it was."""

import json
import warnings
from pathlib import Path

import distributed
import pytest

from talbot.base.jobs import Job, restarts, run
from talbot.base.tools import ToolError
from talbot.models.parameters import ParameterError


def square(number, log):
    if number < 0:
        raise ValueError("negative")
    with Path(log).open("a", encoding="utf-8") as file:
        file.write(f"{number}\n")
    return {"square": number * number}


def jobs_of(numbers, log):
    return [Job(f"n{n}", square, (n, str(log)), (n,)) for n in numbers]


def test_results_in_order_and_each_once(tmp_path):
    log = tmp_path / "log"
    for _ in range(2):
        results = run(jobs_of(range(6), log), tmp_path / "store", "squares", workers=2)
        assert [r["square"] for r in results] == [0, 1, 4, 9, 16, 25]
    assert sorted(map(int, log.read_text().split())) == list(range(6))


def test_a_failed_run_keeps_what_was_done(tmp_path):
    log, store = tmp_path / "log", tmp_path / "store"
    with pytest.raises(ValueError, match="negative"):
        run(jobs_of([1, 2, -1], log), store, "squares", workers=1)
    done = {json.loads(p.read_text())["square"] for p in store.iterdir()}
    assert done == {1, 4}
    run(jobs_of([1, 2, 3], log), store, "squares", workers=1)
    assert sorted(map(int, log.read_text().split())) == [1, 2, 3]


@pytest.mark.parametrize("damage", [b"", b'{"square": ', bytes(range(256))])
def test_a_result_that_is_damaged_is_computed_again(tmp_path, damage):
    log, store = tmp_path / "log", tmp_path / "store"
    run(jobs_of([1, 2], log), store, "squares", workers=1)
    jobs_of([2], log)[0].file(store).write_bytes(damage)
    for _ in range(2):
        assert [r["square"] for r in run(jobs_of([1, 2], log), store, "squares", workers=1)] == [1, 4]
    assert log.read_text().split() == ["1", "2", "2"]


def result_of(number):
    return {"gain": [1.0, number], "offset": 0.0}


@pytest.mark.parametrize("workers", [1, 2])
def test_a_number_that_is_none_is_named(tmp_path, workers):
    with pytest.raises(ToolError, match=r"^hot = gain\.1 nan: must be finite$"):
        run([Job("hot", result_of, (float("nan"),))], tmp_path / "store", "corners", workers)
    assert not list((tmp_path / "store").iterdir())


def test_other_inputs_are_another_job(tmp_path):
    log = tmp_path / "log"
    run([Job("a", square, (2, str(log)), ("x",))], tmp_path / "store", "one", workers=1)
    run([Job("a", square, (3, str(log)), ("y",))], tmp_path / "store", "one", workers=1)
    assert log.read_text().split() == ["2", "3"]


def test_two_jobs_of_one_name(tmp_path):
    with pytest.raises(ParameterError, match="two have one name"):
        run([Job("a", square, (1, "x")), Job("a", square, (1, "x"))], tmp_path, "one")


def test_no_scheduler_there(tmp_path, monkeypatch):
    monkeypatch.setenv("SCHEDULER", "nonsense://nowhere")
    with pytest.raises(ParameterError, match="SCHEDULER = 'nonsense://nowhere'"):
        run([Job("a", square, (1, "x"))], tmp_path, "one")


def worker_of(number):
    """Raises ValueError where no Dask worker does it."""
    from distributed import get_worker

    return {"number": number, "worker": get_worker().address}


def test_on_a_cluster(tmp_path, monkeypatch):
    """Dask workers, met over TCP, do the jobs (joblib does them itself where there is one); results lie as always."""
    jobs = [Job(f"n{n}", worker_of, (n,)) for n in range(4)]
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=False, protocol="tcp", dashboard_address=None
    ) as cluster:
        monkeypatch.setenv("SCHEDULER", cluster.scheduler_address)
        results = run(jobs, tmp_path / "store", "on a cluster")
    assert [r["number"] for r in results] == [0, 1, 2, 3] and all(r["worker"].startswith("tcp://") for r in results)
    monkeypatch.delenv("SCHEDULER")
    assert run(jobs, tmp_path / "store", "kept", workers=1) == results


def test_a_process_that_is_restarted_is_no_warning():
    with warnings.catch_warnings(record=True) as seen:
        warnings.simplefilter("always")
        with restarts():
            warnings.warn("A worker stopped while some jobs were given to the executor.", UserWarning, stacklevel=1)
            warnings.warn("another", UserWarning, stacklevel=1)
    assert [str(warning.message) for warning in seen] == ["another"]
