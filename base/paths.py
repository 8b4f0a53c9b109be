"""Where the repository and what is built from it are."""

from pathlib import Path

ROOT = Path(__file__).parents[1]
BUILD = ROOT / "build"
