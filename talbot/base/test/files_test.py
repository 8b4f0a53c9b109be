import errno
import os
from concurrent.futures import ThreadPoolExecutor, wait
from pathlib import Path
from threading import Event

import pytest

from talbot.base.files import _exchange, check_file, check_folder, insert, marked, part_folder, staged, write
from talbot.models.parameters import ParameterError


def test_files_appear_only_when_all_are_written(tmp_path):
    out = tmp_path / "new"
    with staged(out) as folder:
        (folder / "a").write_text("1")
        assert not (out / "a").exists()
    assert (out / "a").read_text() == "1"
    assert [p.name for p in out.iterdir()] == ["a"]


@pytest.mark.parametrize("error", [OSError("disk full"), KeyboardInterrupt()])
def test_an_error_leaves_nothing(tmp_path, error):
    out = tmp_path / "new"
    with pytest.raises(type(error)), staged(out) as folder:
        (folder / "a").write_text("1")
        raise error
    assert not out.exists()


def test_an_error_leaves_what_was_there(tmp_path):
    (tmp_path / "a").write_text("old")
    with pytest.raises(OSError), staged(tmp_path) as folder:
        (folder / "a").write_text("half")
        raise OSError("disk full")
    assert [(p.name, p.read_text()) for p in tmp_path.iterdir()] == [("a", "old")]


def test_a_name_too_long_for_a_folder_is_refused_before_the_work():
    with pytest.raises(ParameterError, match="out = 'x+': must be a shorter name"):
        check_folder("out", "x" * 5000)


def test_a_place_in_a_document_is_found_or_refused(tmp_path):
    path = tmp_path / "a.md"
    path.write_text("head\n<!-- table -->\nold\n<!-- end of table -->\ntail\n")
    insert(path, "table", "new")
    assert path.read_text() == "head\n<!-- table -->\n\nnew\n\n<!-- end of table -->\ntail\n"
    with pytest.raises(ParameterError, match="must have the comments 'tables' and 'end of tables'"):
        marked(path, "tables")
    path.write_bytes(b"\xff\xfe")
    with pytest.raises(ParameterError, match="a.md: must be a text file"):
        marked(path, "table")


def test_a_folder_in_the_place_of_a_file_is_refused_before_anything_is_written(tmp_path):
    (tmp_path / "report").mkdir()
    with pytest.raises(ParameterError, match="must not have a folder report"), staged(tmp_path, ["report"]):
        raise AssertionError
    with pytest.raises(ParameterError, match="must not have a folder report"), staged(tmp_path) as folder:
        for name in ("a", "report", "z"):
            (folder / name).write_text("new")
    assert [path.name for path in tmp_path.iterdir()] == ["report"]


def test_all_files_move_or_none(tmp_path):
    out, new, old = (tmp_path / name for name in ("out", "new", "old"))
    for folder, names in ((out, "abg"), (new, "ab"), (old, "")):
        folder.mkdir()
        for name in names:
            (folder / name).write_text(folder.name)
    with pytest.raises(FileNotFoundError):
        _exchange(out, new, old, ["a", "b", "missing"], ["g"])
    assert [path.read_text() for path in sorted(out.iterdir())] == ["out"] * 3
    _exchange(out, new, old, ["a", "b"], ["g"])
    assert [path.read_text() for path in sorted(out.iterdir())] == ["new"] * 2


def test_a_folder_replaces_the_one_before(tmp_path):
    for names in ("ab", "bc"):
        with staged(tmp_path) as part:
            (part / "folder").mkdir()
            for name in names:
                (part / "folder" / name).write_text(names)
    assert [path.read_text() for path in sorted((tmp_path / "folder").iterdir())] == ["bc"] * 2


def test_a_folder_that_cannot_be_made_is_refused_before_the_work(tmp_path):
    check_folder("out", tmp_path / "a" / "b")
    assert not list(tmp_path.iterdir())
    for path in ("/proc/out", __file__, f"{__file__}/out"):  # permissions let root write in /proc, which has no room
        with pytest.raises(ParameterError, match=f"out = '{path}': must be a folder"):
            check_folder("out", path)


def test_two_runs_into_one_folder_leave_the_files_of_one(tmp_path):
    """The second moves its files while the first does."""
    out, entered, go = tmp_path / "out", Event(), Event()
    move = os.rename

    def slow(source, target):
        move(source, target)
        if Path(target) == out / "a" and not entered.is_set():
            entered.set()
            assert go.wait(20)

    def run(name):
        with staged(out, ["a", "b"]) as folder:
            for file in "ab":
                (folder / file).write_text(name)

    run("before")
    with pytest.MonkeyPatch.context() as patch, ThreadPoolExecutor(2) as pool:
        patch.setattr(os, "rename", slow)
        first = pool.submit(run, "first")
        assert entered.wait(20)
        second = pool.submit(run, "second")
        assert not wait([second], 0.2).done
        go.set()
        first.result(20)
        second.result(20)
    assert [(out / file).read_text() for file in "ab"] == ["second", "second"]
    assert sorted(path.name for path in out.iterdir()) == ["a", "b"]


def test_a_pipe_or_device_is_written_to_not_replaced(tmp_path):
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    check_file("out", pipe)
    write(pipe, "text")
    assert os.read(reader, 99) == b"text" and pipe.is_fifo()
    os.close(reader)


def test_a_full_disk_names_the_folder(tmp_path):
    with pytest.raises(OSError) as error, part_folder(tmp_path / "out"):
        raise OSError(errno.ENOSPC, "No space left on device")
    assert error.value.filename == str(tmp_path / "out")


def test_a_folder_in_the_place_of_a_result_is_refused_before_any_work(tmp_path):
    (tmp_path / "page.html").mkdir()
    check_folder("out", tmp_path, ["summary.json"])
    with pytest.raises(ParameterError, match="must not have a folder page.html"):
        check_folder("out", tmp_path, ["summary.json", "page.html"])
