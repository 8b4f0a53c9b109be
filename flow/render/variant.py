"""Mitsuba 3 in one of its variants: gray light, with or without polarization, on LLVM."""

import os
import re
from pathlib import Path

from talbot.base.tools import ToolError

PLAIN, POLARIZED = "llvm_ad_mono", "llvm_ad_mono_polarized"
LLVM = "DRJIT_LIBLLVM_PATH"
LLVM_MIN = 17  # with 15 and 16 the process aborts
LIBRARIES = "/usr/lib", "/usr/lib64", "/usr/local/lib", "/opt/homebrew/opt/llvm/lib"


def use(variant: str, threads: int = 1) -> None:
    """Switch Mitsuba to a variant, with so many threads. Raises ToolError where it, or LLVM, is missing."""
    if LLVM not in os.environ:
        os.environ[LLVM] = str(_llvm())
    try:
        import drjit
        import mitsuba
    except ImportError:
        raise ToolError("mitsuba: not installed; pip install 'talbot[render]'") from None
    mitsuba.set_log_level(mitsuba.LogLevel.Error)
    mitsuba.set_variant(variant)
    drjit.set_thread_count(threads)


def use_transients(threads: int = 1) -> None:
    """The same for transients, by mitransient."""
    use(PLAIN, threads)
    try:
        import mitransient
    except ImportError:
        raise ToolError("mitransient: not installed; pip install 'talbot[render]'") from None
    del mitransient  # what it is for is in Mitsuba now


def _llvm() -> Path:
    """The newest LLVM that Mitsuba can use."""
    found = {}
    for folder in map(Path, LIBRARIES):
        for path in [*folder.glob("libLLVM*"), *folder.glob("*/libLLVM*"), *folder.glob("llvm-*/lib/libLLVM*")]:
            version = re.fullmatch(r"libLLVM(?:-|\.so\.)(\d+)[\d.]*(?:\.so|\.dylib)?[\d.]*", path.name)
            if version and int(version[1]) >= LLVM_MIN:
                found[int(version[1])] = path
    if not found:
        raise ToolError(f"LLVM {LLVM_MIN} or later: not found; apt-get install libllvm19, or set {LLVM}")
    return found[max(found)]
