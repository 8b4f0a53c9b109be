#!/usr/bin/env bash
# Tools beside the Python environment, from Debian's packages: Icarus, a native Verilator, Yosys, z3; for cells and
# layouts ngspice, OpenSTA and KLayout; for the tests of the foundry's checks and of OpenROAD's scripts Magic and Tcl;
# for waves as FST the headers of zlib and lz4; for make cosim ngspice as a library.
# With --missing [COMMAND ...] only where one of the commands, by default those of cells and layouts, is missing; the
# command line BEFORE, which checks what they are wanted for, must succeed then.
set -euo pipefail
packages=(iverilog verilator yosys z3 ngspice opensta klayout magic tcl zlib1g-dev liblz4-dev libngspice0-dev)

wanted=()
if [ "${1:-}" = --missing ]; then
    shift
    [ $# -gt 0 ] || set -- iverilog verilator yosys ngspice sta klayout
    for command in "$@"; do
        command -v "$command" >/dev/null || wanted+=("$command")
    done
    [ ${#wanted[@]} -gt 0 ] || exit 0
    bash -c "${BEFORE:-true}" || exit 2
    echo "tools: missing = ${wanted[*]}" >&2
fi

if ! command -v apt-get >/dev/null; then
    echo "tools: apt-get = not found: install ${packages[*]} with this system's own package manager" >&2
    exit 2
fi
if [ "$(id -u)" -ne 0 ]; then
    echo "tools: user = $(id -un): must be root; run: sudo apt-get install ${packages[*]}" >&2
    exit 2
fi
# Another apt may hold the lock for a while (unattended upgrades)
apt-get -o DPkg::Lock::Timeout=600 update -qq
apt-get -o DPkg::Lock::Timeout=600 install -y --no-install-recommends "${packages[@]}"
