"""Mitsuba 3 in one of its variants: gray light, with or without polarization, on LLVM."""

import importlib
import os
import re
from pathlib import Path
from typing import Any

from talbot.base.tools import ToolError

PLAIN, POLARIZED = "llvm_ad_mono", "llvm_ad_mono_polarized"
LLVM = "DRJIT_LIBLLVM_PATH"
LLVM_MIN = 17  # with 15 and 16 the process aborts
LIBRARIES = "/usr/lib", "/usr/lib64", "/usr/local/lib", "/opt/homebrew/opt/llvm/lib"


def mitsuba() -> Any:
    """Mitsuba in its variant. Raises ToolError where it is not installed."""
    return _module("mitsuba")


def _module(name: str) -> Any:
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise ToolError(f"{name} = not installed: must be, to render (pip install 'talbot[render]')") from error


def use(variant: str, threads: int = 1) -> None:
    """Switch Mitsuba to a variant, with ``threads`` threads. Raises ToolError where it, or LLVM, is missing."""
    if LLVM not in os.environ:
        os.environ[LLVM] = str(_llvm())
    mi = mitsuba()
    mi.set_log_level(mi.LogLevel.Error)
    mi.set_variant(variant)
    _module("drjit").set_thread_count(threads)


def use_transients(threads: int = 1) -> None:
    """The same for transients, by mitransient."""
    use(PLAIN, threads)
    _module("mitransient")  # what it is for is in Mitsuba then


def _llvm() -> Path:
    """Return the newest LLVM that Mitsuba can use."""
    found = {}
    for folder in map(Path, LIBRARIES):
        for path in [*folder.glob("libLLVM*"), *folder.glob("*/libLLVM*"), *folder.glob("llvm-*/lib/libLLVM*")]:
            version = re.fullmatch(r"libLLVM(?:-|\.so\.)(\d+)[\d.]*(?:\.so|\.dylib)?[\d.]*", path.name)
            if version and int(version[1]) >= LLVM_MIN:
                found[int(version[1])] = path
    if not found:
        raise ToolError(f"LLVM = not found: must be {LLVM_MIN} or later (Debian: libllvm19), or {LLVM} set to it")
    return found[max(found)]
