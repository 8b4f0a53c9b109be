import os
import shutil

import pytest

from talbot.base import paths
from talbot.base.paths import BUILD, ROOT, build, results
from talbot.base.supervise import RUN


def test_a_checkout_keeps_what_it_builds():
    assert BUILD == ROOT / "build"


def test_an_installation_keeps_it_in_the_users_cache(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    assert build(tmp_path / "site-packages") == tmp_path / "cache" / "talbot"


def test_results_are_in_the_working_directory_or_where_others_are_kept(checkout, monkeypatch):
    root, denied = checkout
    monkeypatch.chdir(root)
    assert results() == root / "build"
    denied.add(str(root / "build"))
    assert results() == BUILD


@pytest.fixture
def checkout(tmp_path, monkeypatch):
    """A checkout, and a user with a cache, as far as os.access can say it: root may write everywhere."""
    (tmp_path / "checkout" / "build" / "simulator").mkdir(parents=True)
    (tmp_path / "checkout" / "pyproject.toml").touch()
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setenv(paths.CHOSEN, "")  # so that what `build` sets goes after the test
    monkeypatch.delenv(paths.CHOSEN)
    monkeypatch.setattr(paths.tempfile, "tempdir", str(tmp_path))
    monkeypatch.delenv(RUN, raising=False)
    denied = set()
    access = os.access
    monkeypatch.setattr(paths.os, "access", lambda path, mode: str(path) not in denied and access(path, mode))
    return tmp_path / "checkout", denied


@pytest.mark.parametrize("denied", ["", "build", "build/simulator"])
def test_what_another_user_has_built_is_left_and_the_cache_used_with_one_line(checkout, tmp_path, capsys, denied):
    root, names = checkout
    names.add(str(root / denied))
    if not denied:
        shutil.rmtree(root / "build")  # a checkout that is read-only
    assert build(root) == tmp_path / "cache" / "talbot"
    assert capsys.readouterr().err.splitlines() == [
        f"talbot: {(root / denied)} is not yours to write: {tmp_path}/cache/talbot is used in its place"
    ]


def test_a_folder_that_another_process_removes_meanwhile_denies_nothing(checkout, monkeypatch, capsys):
    root, _ = checkout
    access = os.access

    def removed(path, mode):
        if os.path.basename(path) == "simulator":
            os.rmdir(path)
        return access(path, mode)

    monkeypatch.setattr(paths.os, "access", removed)
    assert build(root) == root / "build" and not capsys.readouterr().err


def test_a_user_without_a_home_has_a_folder_among_the_temporary_ones(checkout, tmp_path):
    root, names = checkout
    names |= {str(root / "build"), str(tmp_path)}
    folder = build(root)
    assert folder == tmp_path / f"talbot-{os.getuid()}" and folder.stat().st_mode & 0o777 == 0o700


def test_a_folder_of_ones_own_is_used(checkout, capsys):
    root, _ = checkout
    assert build(root) == root / "build" and not capsys.readouterr().err
