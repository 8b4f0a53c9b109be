"""Where the package, the repository and what is built from it are."""

from pathlib import Path

from platformdirs import user_cache_path

PACKAGE = Path(__file__).parents[1]  # the folder talbot, as Python found it: in a checkout its parts are links
ROOT = PACKAGE.parent  # the repository, or the folder of an installation's packages


def build(root: Path) -> Path:
    """Folder of what is built and kept: the repository's own, or the user's cache where ``root`` is an installation."""
    return root / "build" if (root / "pyproject.toml").is_file() else user_cache_path("talbot", appauthor=False)


def results(root: Path) -> Path:
    """Folder of results by default: the repository's own, or one in the working directory."""
    return root / "build" if (root / "pyproject.toml").is_file() else Path("build")


BUILD, RESULTS = build(ROOT), results(ROOT)
