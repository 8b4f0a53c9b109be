#!/usr/bin/env bash
# The Python environment: venv.sh PYTHON FOLDER READY LOCK ... makes the file READY once every package of the files LOCK is
# in FOLDER at its version and hash.
set -euo pipefail
python=$1 folder=$2 ready=$3
here=$(cd "$(dirname "$0")" && pwd)

fail() { echo "setup: $*" >&2; exit 2; }

# Who sets up may differ from who uses it
umask 022
# A user's own settings of Python and pip change nothing here; how to reach a registry is this machine's
for name in ${!PYTHON@} ${!PIP_@}; do
    case $name in
        PIP_INDEX_URL | PIP_EXTRA_INDEX_URL | PIP_FIND_LINKS | PIP_NO_INDEX | PIP_TRUSTED_HOST | PIP_CERT | PIP_CLIENT_CERT) ;;
        PIP_PROXY | PIP_DEFAULT_TIMEOUT | PIP_TIMEOUT | PIP_RETRIES | PIP_CACHE_DIR | PIP_NO_CACHE_DIR | PIP_CONFIG_FILE) ;;
        PIP_KEYRING_PROVIDER) ;;
        *) unset "$name" ;;
    esac
done
export PIP_USER=0 PIP_DISABLE_PIP_VERSION_CHECK=1

[ -d "$here/../talbot/rtl/" ] || fail "talbot/rtl = not a link: the checkout must have symbolic links (Windows: use WSL and" \
    "its own file system, or git config core.symlinks true; then git checkout -- talbot)"

fits() { "$1" -c 'import sys; sys.exit(not (3, 11) <= sys.version_info < (3, 15))' 2>/dev/null; }
found() { "$1" -c 'import platform, sys; print("Python", platform.python_version(), "at", sys.executable)' 2>/dev/null \
    || echo nothing; }
given=$python
if [ "$python" = python3 ]; then # the default: this one, or another of the system's
    for python in python3 python3.14 python3.13 python3.12 python3.11; do
        ! fits "$python" || break
    done
fi
fits "$python" || fail "python = '$given': must be Python 3.11 to 3.14, is $(found "$given") (make PYTHON=/path/to/python3)"

command -v g++ >/dev/null || fail "g++ = not found: a C++ compiler is needed (Debian: apt-get install g++; macOS: xcode-select --install)"

# One set-up at a time: a lock on this script, which ends with this process. macOS has no flock(1)
exec 9<"$0"
lock='import fcntl, sys; fcntl.flock(9, fcntl.LOCK_EX | (fcntl.LOCK_NB if sys.argv[1:] else 0))'
"$python" -c "$lock" now 2>/dev/null || { echo "setup: waiting for another set-up of this checkout"; "$python" -c "$lock" || true; }
shift 3
newer=
for lock in "$@" "$0" "$here/../pyproject.toml"; do
    [ "$ready" -nt "$lock" ] || newer=1
done
[ -n "$newer" ] || { touch "$ready"; exit 0; } # that one has done it

if ! "$folder/bin/python" -m pip --version >/dev/null 2>&1; then
    echo "setup: making $folder with $(found "$python")"
    rm -rf "$folder" # half-made, or its Python is gone
    # pip of the wheel that ensurepip has, unpacked: ensurepip itself takes ten times as long. Debian splits ensurepip off Python;
    # virtualenv brings its pip.
    wheel='import ensurepip, glob, os, sysconfig, zipfile
folders = os.path.join(os.path.dirname(ensurepip.__file__), "_bundled"), sysconfig.get_config_var("WHEEL_PKG_DIR") or "-"
wheels = [file for folder in folders for file in glob.glob(os.path.join(folder, "pip-*.whl"))]
zipfile.ZipFile(wheels[0]).extractall(sysconfig.get_path("purelib"))'
    { "$python" -m venv --without-pip "$folder" && "$folder/bin/python" -c "$wheel" && "$folder/bin/python" -m pip --version; } \
        >/dev/null 2>&1 || { rm -rf "$folder"; "$python" -m venv "$folder"; } 2>/dev/null \
        || { rm -rf "$folder"; "$python" -m virtualenv -q "$folder"; } 2>/dev/null \
        || fail "venv = unavailable in '$python': install python3-venv (Debian: apt-get install python3-venv) or virtualenv"
fi

# The same of the files pip.conf, of which pip then reads none
registry='import ast, os, sys
keys = "index-url extra-index-url find-links no-index trusted-host cert client-cert proxy default-timeout timeout retries"
keys, found = [*keys.split(), "cache-dir", "no-cache-dir", "keyring-provider"], {}
for line in sys.stdin:
    name, _, value = line.strip().partition("=")
    section, _, key = name.partition(".")
    if section in ("global", "install") and key in keys:  # in this order
        found["PIP_" + key.upper().replace("-", "_")] = " ".join(ast.literal_eval(value).split())
print(*(f"{name}={value}" for name, value in found.items() if name not in os.environ), sep="\n")'
while IFS= read -r setting; do
    [ -z "$setting" ] || export "${setting?}"
done < <("$folder/bin/python" -m pip config list | "$folder/bin/python" -c "$registry")
export PIP_CONFIG_FILE=/dev/null

# OpenROAD's wheel is for x86-64 with glibc 2.38 and later. A system with an older one gets the wheel and the C library of
# its next release in a folder of the environment, from which talbot/base/openroad.py runs it
openroad_fits() { [ "$(printf '%s\n' 2.38 "$1" | sort -V | sed -n 1p)" = 2.38 ]; }
requirements=() unpacked="" native=""
for lock in "$@"; do
    case $lock in
        *openroad.lock)
            libc=$(getconf GNU_LIBC_VERSION 2>/dev/null || true)
            if [ "$(uname -sm)" != "Linux x86_64" ] || [ -z "$libc" ]; then
                echo "setup: openroad = no package for $(uname -sm): left out" >&2
            elif openroad_fits "${libc#glibc }"; then
                requirements+=(-r "$lock") native=1
            elif ! command -v apt-get >/dev/null; then
                echo "setup: openroad = no package for $libc, must be 2.38 or later, or a system with apt: left out" >&2
            else
                unpacked=$lock
            fi ;;
        *) requirements+=(-r "$lock") ;;
    esac
done
echo "setup: installing the packages of $*"
# uv unpacks with all cores, in a fifth of pip's time; it gets pip's registry. Where it fails pip installs, or says why not
unset ${!UV_@}
export UV_NO_CONFIG=1 UV_NATIVE_TLS=1 UV_INDEX_STRATEGY=unsafe-best-match
for pair in UV_DEFAULT_INDEX=PIP_INDEX_URL UV_INDEX=PIP_EXTRA_INDEX_URL UV_FIND_LINKS=PIP_FIND_LINKS UV_NO_INDEX=PIP_NO_INDEX \
    UV_INSECURE_HOST=PIP_TRUSTED_HOST UV_HTTP_TIMEOUT=PIP_DEFAULT_TIMEOUT UV_KEYRING_PROVIDER=PIP_KEYRING_PROVIDER \
    SSL_CERT_FILE=PIP_CERT SSL_CLIENT_CERT=PIP_CLIENT_CERT HTTPS_PROXY=PIP_PROXY; do
    value=${pair#*=}
    [ -z "${!value:-}" ] || export "${pair%=*}=${!value}"
done
[ -z "${UV_FIND_LINKS:-}" ] || UV_FIND_LINKS=${UV_FIND_LINKS// /,}
install() {
    "$folder/bin/uv" pip install --quiet --python "$folder/bin/python" --no-deps "$@" 2>/dev/null \
        || "$folder/bin/python" -m pip install --quiet --no-deps --no-compile "$@"
}
[ -x "$folder/bin/uv" ] || "$folder/bin/python" -m pip install --quiet --no-deps --no-compile --require-hashes \
    -r "$here/uv.lock" 2>/dev/null || true # a registry without it
# A lock names all that its packages depend on. pip compiles 6,000 modules with one core. compileall compiles those that a frame
# or the tests load, with all cores, while the project is installed; Python compiles the others when it imports them
of_tests='hypothesis|_pytest|pluggy|py|sortedcontainers|joblib|tifffile|'
of_tests+='scipy/(stats|optimize|sparse|integrate|interpolate|spatial|constants)|'
case " $* " in
    *test.lock*) of_tests="" ;; # each process of the tests would compile them
esac
later="site-packages/((.*/)?(tests?|testcases)|${of_tests}pip|setuptools|networkx|fontTools|pygments|sklearn"
later+='|systemrdl|antlr4|markdown|packaging|imageio|contourpy'
later+='|plotly|_plotly_utils|narwhals|sphinx|docutils|snowballstemmer|babel|myst_parser|markdown_it|mdit_py_plugins|dask|fsspec'
later+='|pydantic|pydantic_core|fastjsonschema|edalize|fusesoc|okonomiyaki|simplesat|cocotb|cocotb_tools|wasmtime|meent|rich'
later+='|urllib3|requests|idna|bs4|soupsieve|scipy/(_lib/(cobyqa|pyprima)|odr|fftpack|signal|io|cluster)'
later+='|numba/cuda|numpy/(distutils|f2py)|matplotlib/backends|skimage/(feature|measure|morphology|transform|filters)|mpl_toolkits)/'
install --require-hashes "${requirements[@]}"
"$folder/bin/python" -m compileall -q -j 0 -x "$later" "$folder"/lib/python*/site-packages >/dev/null 2>&1 & # of templates, too
trap "kill $! 2>/dev/null || true" EXIT
case " $* " in # the project itself, with the packages that it cannot do without
    *run.lock*) install --no-build-isolation --editable . ;;
esac
wait
trap - EXIT
# From zlib 1.3.2 on, of which Python's process takes a part of the wheel's calls, it crashes as it reads a file
if [ "$native" ] && "$folder/bin/python" -c 'import sys, zlib
version = [int(part) for part in zlib.ZLIB_RUNTIME_VERSION.split(".")[:3] if part.isdigit()]
sys.exit(version < [1, 3, 2])' && command -v apt-get >/dev/null; then
    rm -rf "$folder/openroad"
    bash "$here/tools.sh" --library zlib1g "$folder/openroad/libc"
fi
if [ "$unpacked" ]; then
    rm -rf "$folder/openroad" "$folder/openroad.new"
    "$folder/bin/python" -m pip install --quiet --no-deps --require-hashes --only-binary=:all: \
        --platform manylinux_2_38_x86_64 --target "$folder/openroad.new/package" -r "$unpacked"
    bash "$here/tools.sh" --library libc6 "$folder/openroad.new/libc"
    mv "$folder/openroad.new" "$folder/openroad"
fi
touch "$ready"
echo "setup: ready, $(found "$folder/bin/python")"
