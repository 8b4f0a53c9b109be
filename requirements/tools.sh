#!/usr/bin/env bash
# The tools that PyPI does not have, from Debian's packages: Icarus, a native Verilator, z3; for cells and layouts
# ngspice, OpenSTA and KLayout; for a foundry's cells a Yosys with Tcl; for tests Magic and Tcl; for waves
# as FST the headers of zlib and lz4; for make cosim ngspice as a library.
# As root they are installed. As another user apt fetches and verifies them with folders of its own, and they are
# unpacked in the user's cache: the system is not touched. talbot/base/environment.py adds them to PATH.
# With --missing [COMMAND ...] only where one of the commands, by default those of cells and layouts, is missing; the
# command line BEFORE, which checks what they are for, must succeed then. With --library PACKAGE FOLDER alone the
# libraries of PACKAGE of another release, unpacked in FOLDER, for a program that asks for them (venv.sh).
set -euo pipefail
packages=(iverilog verilator yosys z3 ngspice opensta klayout magic tcl zlib1g-dev liblz4-dev libngspice0-dev)
folder=${XDG_CACHE_HOME:-${HOME:?}/.cache}/talbot/tools # talbot.base.paths.TOOLS

fail() { echo "tools: $*" >&2; exit 2; }

# Make apt fetch and verify with folders of its own, below FOLDER, and renew its lists; options on top for both
private_apt() { # FOLDER [OPTION ...]
    local folder=$1
    apt_options=(-qq -o "Dir::State::Lists=$folder/lists" -o "Dir::Cache=$folder" -o "APT::Sandbox::User=$(id -un)"
        -o Debug::NoLocking=1 "${@:2}")
    mkdir -p "$folder/lists/partial" "$folder/archives/partial"
    ! apt-get "${apt_options[@]}" update 2>"$folder/errors" || return 0
    # A mirror that stands still: its lists are signed, but of a day that is past
    grep -q 'is expired' "$folder/errors" || { cat "$folder/errors" >&2; exit 2; }
    echo "tools: the mirror's lists are expired: their signatures alone are checked" >&2
    apt_options+=(-o Acquire::Check-Valid-Until=false)
    apt-get "${apt_options[@]}" update
}

if [ "${1:-}" = --library ]; then
    package=$2 folder=$3
    # shellcheck source=/dev/null
    case $(. /etc/os-release && echo "${UBUNTU_CODENAME:-${VERSION_CODENAME:-}}") in
        bookworm | forky | sid) release=trixie ;;
        jammy) release=noble ;;
        *) fail "$package = no release known that has it: must be Debian or Ubuntu 22.04" ;;
    esac
    mirror=$(apt-get indextargets --format "\$(REPO_URI)" | grep -E -m 1 '/(debian|ubuntu)/?$') \
        || fail "mirror = none of Debian's or Ubuntu's among apt's sources"
    rm -rf "$folder"
    mkdir -p "$folder/apt"
    folder=$(cd "$folder" && pwd)
    echo "deb $mirror $release main" >"$folder/apt/sources.list"
    echo "tools: fetching $package of $release, in $folder (3 MB)"
    private_apt "$folder/apt" -o "Dir::Etc::SourceList=$folder/apt/sources.list" -o Dir::Etc::SourceParts=/dev/null \
        -o Dir::State::status=/dev/null
    (cd "$folder/apt/archives" && apt-get "${apt_options[@]}" download "$package")
    dpkg-deb -x "$folder"/apt/archives/"$package"_*.deb "$folder/apt/root"
    mv "$folder"/apt/root/usr/lib/*-linux-gnu/*.so* "$folder"
    rm -rf "$folder/apt"
    exit
fi

missing=()
if [ "${1:-}" = --missing ]; then
    shift
    [ $# -gt 0 ] || set -- iverilog verilator ngspice klayout
    for command in "$@"; do
        [ -x "$folder/bin/$command" ] || command -v "$command" >/dev/null || missing+=("$command")
    done
    [ ${#missing[@]} -gt 0 ] || exit 0
    bash -c "${BEFORE:-true}" || exit 2
    echo "tools: missing = ${missing[*]}" >&2
fi

command -v apt-get >/dev/null \
    || fail "apt-get = not found: install ${packages[*]} with this system's own package manager"

apt_options=(-o DPkg::Lock::Timeout=600) # another apt may hold the lock for a while (unattended upgrades)
# Leave out of `packages` what this release does not have (Debian 13 has no Magic)
known_packages() {
    local package known=()
    for package in "${packages[@]}"; do
        if [[ $(LC_ALL=C apt-cache "${apt_options[@]}" policy "$package") =~ "Candidate: "[^\(] ]]; then
            known+=("$package")
        else
            echo "tools: $package = not in this release: left out" >&2
        fi
    done
    packages=("${known[@]}")
}
if [ "$(id -u)" -eq 0 ]; then
    apt-get "${apt_options[@]}" update -qq
    known_packages
    exec apt-get "${apt_options[@]}" install -y --no-install-recommends "${packages[@]}"
fi

# A program of the unpacked packages with the libraries and settings that it looks for elsewhere
wrap() { # NAME PROGRAM [VARIABLE=VALUE ...] [-- ARGUMENT ...]
    local name=$1 program=$2 settings=() arguments=()
    shift 2
    [ -e "$new/root${program#"$root"}" ] || return 0 # the system has it, or the release lacks it
    while [ $# -gt 0 ] && [ "$1" != -- ]; do settings+=("$1"); shift; done
    [ $# -eq 0 ] || { shift; arguments=("$@"); }
    {
        printf '#!/bin/sh\n'
        # shellcheck disable=SC2016 # expanded by the program's shell
        printf '%s=%q${%s:+:$%s}\n' LD_LIBRARY_PATH "$libraries" LD_LIBRARY_PATH LD_LIBRARY_PATH \
            PATH "$folder/bin" PATH PATH
        printf 'export LD_LIBRARY_PATH PATH %s\n' "${settings[*]+${settings[*]@Q}}"
        printf 'exec %q %s "$@"\n' "$program" "${arguments[*]+${arguments[*]@Q}}"
    } >"$new/bin/$name"
    chmod +x "$new/bin/$name"
}

mkdir -p "$folder"
exec 9>"$folder/lock"
flock 9 # two first runs at once
echo "tools: fetching ${packages[*]} for $(id -un), in $folder (about 200 MB, 800 MB unpacked)"
private_apt "$folder/apt"
known_packages
apt-get "${apt_options[@]}" -y --no-install-recommends --download-only install "${packages[@]}" >/dev/null
new=$folder/new root=$folder/root
rm -rf "$new"
mkdir -p "$new/root" "$new/bin"
for package in "$folder"/apt/archives/*.deb; do dpkg-deb -x "$package" "$new/root"; done
rm -rf "$folder/apt"

triplet=$(cd "$new/root/usr/lib" && echo *-linux-gnu)
edit() { # EXPRESSION FILE ...: those of the files that are there
    local expression=$1 file
    shift
    for file; do [ ! -f "$file" ] || sed -i -E "$expression" "$file"; done
}
lib=$root/usr/lib/$triplet
libraries=$lib:$lib/blas:$lib/lapack:$lib/pulseaudio:$root/usr/lib/klayout:$root/lib/$triplet
# Scripts that name their own files by absolute paths
edit "s#/usr/lib/[^ /]*/ngspice#$root&#" "$new/root/usr/share/ngspice/scripts/spinit"
edit "s#/usr/lib/[^ /]*/magic#$root&#" "$new/root/usr/lib/$triplet/magic/tcl/magic.tcl"
[ ! -d "$new/root/usr/share/verilator/bin" ] || ln -sf ../../../bin/verilator_bin "$new/root/usr/share/verilator/bin/"
for name in yosys berkeley-abc z3; do wrap "$name" "$root/usr/bin/$name"; done
wrap iverilog "$root/usr/bin/iverilog" -- -B "$lib/ivl"
wrap vvp "$root/usr/bin/vvp" -- -M "$lib/ivl"
wrap verilator "$root/usr/bin/verilator" "VERILATOR_ROOT=$root/usr/share/verilator"
wrap verilator_coverage "$root/usr/bin/verilator_coverage" "VERILATOR_ROOT=$root/usr/share/verilator"
wrap ngspice "$root/usr/bin/ngspice" "SPICE_LIB_DIR=$root/usr/share/ngspice"
release() { echo "${1##*/}"; } # the first of the files that a pattern names
tcl=$(release "$new"/root/usr/share/tcltk/tcl8*)
for name in sta tclsh; do wrap "$name" "$root/usr/bin/$name" "TCL_LIBRARY=$root/usr/share/tcltk/$tcl"; done
if [ -d "$new/root/usr/lib/$triplet/magic" ]; then
    # Its own program looks for magic.tcl in /usr; without a window (-dnull) Tcl's runs it as well
    wrap magic "$root/usr/bin/tclsh" "CAD_ROOT=$lib" "TCL_LIBRARY=$root/usr/share/tcltk/$tcl" \
        -- "$lib/magic/tcl/magic.tcl" -nowrapper
fi
ruby=$(release "$new"/root/usr/lib/ruby/[0-9]*)
wrap klayout "$root/usr/lib/klayout/klayout" "QT_PLUGIN_PATH=$lib/qt5/plugins" \
    "RUBYLIB=$root/usr/lib/ruby/$ruby:$lib/ruby/$ruby:$root/usr/lib/ruby/vendor_ruby"

# Headers and libraries to compile with, alone: the rest of these folders would hide the system's
mkdir "$new/include" "$new/lib"
for header in zlib.h zconf.h lz4.h lz4frame.h lz4hc.h ngspice; do
    for path in "$new/root/usr/include/$header" "$new/root/usr/include/$triplet/$header"; do
        [ ! -e "$path" ] || ln -s "$root${path#"$new/root"}" "$new/include/"
    done
done
for name in z:1 lz4:1 ngspice:0; do
    library=lib${name%:*}.so.${name#*:}
    for path in "$new/root/usr/lib/$triplet/$library" "/usr/lib/$triplet/$library"; do
        [ -e "$path" ] || continue
        ln -s "${path/#$new/$folder}" "$new/lib/$library"
        ln -s "$library" "$new/lib/lib${name%:*}.so"
        break
    done
done

for part in root include lib bin; do
    rm -rf "${folder:?}/$part"
    mv "$new/$part" "$folder/$part"
done
rmdir "$new"
echo "tools: ready in $folder/bin: $(cd "$folder/bin" && echo *)"
