"""Steps: run once for the same inputs, held to what they declare."""

import multiprocessing
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import joblib
import pytest

from talbot.base.steps import Runner, StepError
from talbot.base.steps.test.steps import (
    Again,
    Both,
    Careless,
    Circle,
    Crash,
    Greet,
    Last,
    Long,
    Meet,
    Order,
    Patient,
    Plain,
    Priority,
    Reader,
    Repeat,
    Times,
    Turn,
    waited,
)
from talbot.models.parameters import ParameterError


@pytest.fixture
def text(tmp_path):
    (tmp_path / "text").write_text("ab")
    return tmp_path / "text"


def test_a_step_has_plain_paths_where_those_of_the_user_are_not(tmp_path):
    (tmp_path / "a b;$c").mkdir()
    (tmp_path / "a b;$c" / "te xt").write_text("x")
    runner = Runner(tmp_path / "a b;$c" / "steps", {"text": tmp_path / "a b;$c" / "te xt"})
    runner.run(Plain())
    assert re.fullmatch(r"[\w./-]+ [\w./-]+", runner.paths["plain.text"].read_text())
    assert len(list((tmp_path / "a b;$c" / "steps").glob("plain.*/out.txt"))) == 1


def test_a_chain_runs_once_and_again_when_its_input_changed(tmp_path, text):
    def run():
        runner = Runner(tmp_path / "steps", {"text": text})
        return [runner.run(step) for step in (Repeat(Times(3)), Again())], runner.paths["again.text"]

    (first, second), path = run()
    assert path.read_text() == "ab" * 6 and second["metrics"] == {"length": 12}
    assert first["parameters"] == {"times": 3} and first["parameter_units"] == {"times": "1"}
    made = path.stat().st_mtime_ns
    assert run()[1].stat().st_mtime_ns == made
    text.write_text("c")
    assert run()[1].read_text() == "c" * 6
    assert path.exists()


def test_steps_that_do_not_need_each_other_run_together(tmp_path, text):
    runner = Runner(tmp_path / "steps", {"text": text})
    records = runner.run_all([Meet(), Both(), Greet()])
    assert [record["step"] for record in records] == ["meet", "both", "greet"]
    assert runner.paths["both.text"].read_text() == "TrueTrue"


def test_a_step_runs_beside_others(tmp_path, text):
    runner = Runner(tmp_path / "steps", {"text": text})
    with runner.beside([Both(), Greet(), Crash()]):
        runner.run(Meet())
        assert set(runner.records) == {"meet"} and "greet.text" not in runner.paths
        assert waited(lambda: list((tmp_path / "steps").glob("both.*/out.txt")))  # from the chain's results and its own
    assert runner.run(Greet())["metrics"] == {"length": 0}
    assert runner.paths["greet.text"].read_text() == "True"
    with pytest.raises(StepError, match="ended with no result"):
        runner.run(Crash())


def test_what_another_run_has_made_is_given_and_that_run_has_the_cores(tmp_path, text):
    runner, other = Runner(tmp_path / "steps", {}), Runner(tmp_path / "other", {"text": text})
    with runner.beside([Priority()], lambda: other.paths):
        other.run_all([Repeat(), Priority()])
        assert waited(lambda: list((tmp_path / "steps").glob("priority.*/out.txt")))
    assert runner.paths == {}
    given, own = next((tmp_path / "steps").glob("priority.*/out.txt")), other.paths["priority.text"]
    assert int(given.read_text()) > int(own.read_text()) == os.nice(0)


def children() -> list[str]:
    """Processes of steps; a worker of joblib's that an earlier test has left is none."""
    return [one.name for one in multiprocessing.active_children() if not one.name.startswith("Loky")]


def test_what_runs_beside_ends_without_what_another_runs(tmp_path, text):
    with Runner(tmp_path / "steps", {"text": text}).beside([Long()]):
        assert waited(lambda: len(children()) == 1)
        with Runner(tmp_path / "other", {"text": text}).beside([Long()]):
            assert waited(lambda: len(children()) == 2)
        assert len(children()) == 1
    assert not children()


def test_what_ran_beside_ends_with_it(tmp_path, text):
    runner = Runner(tmp_path / "steps", {"text": text})
    with pytest.raises(KeyboardInterrupt), runner.beside([Meet()]):
        assert waited((tmp_path / "meet").exists)
        raise KeyboardInterrupt
    assert not children() and not list((tmp_path / "steps").glob("meet.*"))


def test_other_paths_are_other_inputs(tmp_path, text):
    runner, other = Runner(tmp_path / "steps", {"text": text}), tmp_path / "other"
    other.write_text("c")
    with runner.beside([Repeat(Times(2))]):
        assert waited(lambda: len(list((tmp_path / "steps").glob("repeat.*/out.txt"))) == 1)
        runner.paths = {"text": other}
        assert waited(lambda: len(list((tmp_path / "steps").glob("repeat.*/out.txt"))) == 2)


def test_a_chain_goes_on_while_others_have_all_cores(tmp_path, text):
    runner, others = Runner(tmp_path / "steps", {"text": text}), [Patient(k) for k in range(joblib.cpu_count())]
    runner.run_all([*others, Repeat(), Again(), Last(), Reader()])
    assert [runner.paths[f"{step.name}.text"].read_text() for step in others] == ["True"] * len(others)


def test_a_circle_is_told(tmp_path, text):
    with pytest.raises(StepError, match="steps: (circle needs turn needs circle|turn needs circle needs turn)"):
        Runner(tmp_path / "steps", {"text": text}).run_all([Circle(), Turn()])


def test_of_steps_that_run_together_the_failed_one_is_told(tmp_path, text):
    with pytest.raises(StepError, match="ended with no result"):
        Runner(tmp_path / "steps", {"text": text}).run_all([Crash(), Repeat()])


def test_no_steps_have_no_records(tmp_path):
    assert Runner(tmp_path / "steps", {}).run_all([]) == []


def test_a_step_that_breaks_its_declaration_leaves_nothing(tmp_path, text):
    with pytest.raises(StepError, match=r"did not write \['out.txt'\], wrote undeclared \['more.txt'\]"):
        Runner(tmp_path / "steps", {"text": text}).run(Careless())
    assert not list((tmp_path / "steps").iterdir())


def test_a_crash_in_a_step_is_told(tmp_path, text):
    with pytest.raises(StepError, match="ended with no result"):
        Runner(tmp_path / "steps", {"text": text}).run(Crash())


def test_a_missing_input_is_named(tmp_path):
    with pytest.raises(StepError, match="nothing gives its input repeat.text"):
        Runner(tmp_path, {}).run(Again())


def test_parameters_of_another_step_are_refused():
    with pytest.raises(ParameterError, match="must be a Times"):
        Repeat({"times": 2})


def test_sets_have_the_same_order_in_every_run(tmp_path, text):
    for folder in "ab":
        Runner(tmp_path / folder, {"text": text}).run(Order())
    first, second = (next((tmp_path / folder).glob("order.*/out.txt")).read_text() for folder in "ab")
    assert first == second


# Ctrl-C counts also where the tests run behind a shell that ignores it
RUN_TOOL = (
    "import signal; signal.signal(signal.SIGINT, signal.default_int_handler); "
    "from talbot.base.steps import Runner; from talbot.base.steps.test.steps import Tool; from pathlib import Path; "
    "Runner(Path({folder!r}), {{'text': Path({text!r})}}).{call}"
)


@pytest.mark.parametrize("call", ["run(Tool())", "run_all([Tool()])"])
@pytest.mark.parametrize("sent", [signal.SIGTERM, signal.SIGINT, signal.SIGKILL])
def test_a_killed_run_leaves_no_tool(tmp_path, text, sent, call):
    text.write_text("")
    run = subprocess.Popen(
        [sys.executable, "-c", RUN_TOOL.format(folder=str(tmp_path / "steps"), text=str(text), call=call)],
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )
    assert waited(lambda: text.read_text().endswith("\n"))
    tool = int(text.read_text())
    time.sleep(0.3)  # the tool speaks before Popen has returned: who is killed right there knows no tool to end
    run.send_signal(sent)
    run.wait(timeout=200)
    assert waited(lambda: not Path(f"/proc/{tool}").exists())
