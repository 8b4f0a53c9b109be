import pytest

from base.files import staged


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
