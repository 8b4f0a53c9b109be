"""Places of the package, the repository and its build."""

import os
import sys
import tempfile
from pathlib import Path

from platformdirs import user_cache_path

from talbot.base.supervise import lasting_temporary

PACKAGE = Path(__file__).parents[1]  # the folder talbot, as Python found it: in a checkout its parts are links
ROOT = PACKAGE.parent  # the repository, or the folder of an installation's packages
CHOSEN = "TALBOT_BUILD"  # the environment's name of the folder that a process above this one has chosen


def build(root: Path) -> Path:
    """Folder of what is built and kept: the repository's own, or the user's cache where ``root`` is an installation.

    Where this user may not write it, or one of its folders (root has built there), the cache, with one line; without a
    cache, as of a user that the system does not know, a folder among the temporary ones.
    """
    if chosen := os.environ.get(CHOSEN):
        return Path(chosen)
    cache = user_cache_path("talbot", appauthor=False)
    if not (root / "pyproject.toml").is_file():
        return cache if not unwritable(cache) else _temporary()
    in_checkout = root / "build"
    if not (first := unwritable(in_checkout)):
        return in_checkout
    folder = cache if not unwritable(cache) else _temporary()
    os.environ[CHOSEN] = str(folder)  # of processes below this one, which say nothing more
    print(f"talbot: {first} is not yours to write: {folder} is used in its place", file=sys.stderr)
    return folder


def unwritable(folder: Path) -> Path | None:
    """Return the first of ``folder``, or what is above it, and its folders in which this user may not write."""
    existing = next(path for path in (folder, *folder.absolute().parents) if os.path.lexists(path))
    if not os.access(existing, os.W_OK | os.X_OK):
        return existing
    if existing != folder:
        return None
    denied = (path for path in folder.iterdir() if path.is_dir() and not os.access(path, os.W_OK))
    return next((path for path in denied if path.exists()), None)  # not one that another process has removed since


def _temporary() -> Path:
    """A folder of this user's among the temporary ones; of another user's, who waits for what is kept there, none."""
    folder = lasting_temporary() / f"talbot-{os.getuid()}"
    folder.mkdir(mode=0o700, exist_ok=True)
    return folder if folder.stat().st_uid == os.getuid() else Path(tempfile.mkdtemp(prefix="talbot-"))


def results() -> Path:
    """Folder of all results by default: build in the working directory, for `make` the checkout's.

    Where that cannot be written, BUILD.
    """
    here = Path.cwd() / "build"
    return BUILD if unwritable(here) else here


def results_of(command: str) -> Path:
    """Folder of a command's results in `results`, by a relative path where that is build/ here."""
    here = Path("build")
    return (BUILD if unwritable(here) else here) / command


def caches() -> None:
    """Give Numba and Matplotlib a folder of BUILD where they could write none of theirs."""
    home = Path(os.path.expanduser("~"))
    if unwritable(home / ".config" / "matplotlib") or unwritable(home / ".cache" / "matplotlib"):
        os.environ.setdefault("MPLCONFIGDIR", str(BUILD / "matplotlib"))
    if not os.access(PACKAGE / "models", os.W_OK):
        os.environ.setdefault("NUMBA_CACHE_DIR", str(BUILD / "numba"))


BUILD = build(ROOT)
RESULTS = results()
