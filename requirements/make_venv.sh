#!/bin/sh
# Make (or mend) the virtual environment FOLDER from the lock of the Python found, and install stackloft in it.
#
#   sh requirements/make_venv.sh FOLDER          PYTHON=python3.12 sh requirements/make_venv.sh FOLDER
#
# Every package comes from requirements/pyVERSION.txt and is checked against its hash.
set -eu

folder=${1:?usage: make_venv.sh FOLDER}
here=$(cd "$(dirname "$0")" && pwd)

say() { printf '%s\n' "$*" >&2; }

# "3.12" when $1 runs and is a CPython, nothing otherwise (a pyenv shim may be there and refuse to run).
version_of() {
    "$1" -c 'import sys; print("%d.%d" % sys.version_info[:2])' 2>/dev/null || true
}

find_python() {
    found=""
    for candidate in ${PYTHON:-python3 python3.13 python3.12 python3.11 python3.14}; do
        version=$(version_of "$candidate")
        [ -n "$version" ] || continue
        found="$found $candidate=$version"
        if [ -f "$here/py$version.txt" ]; then
            echo "$candidate"
            return
        fi
    done
    locks=$(cd "$here" && ls py*.txt | sed 's/^py//; s/\.txt$//' | tr '\n' ' ')
    say "stackloft needs one of these Python versions: $locks"
    say "found:${found:- none}"
    say "On Debian or Ubuntu: sudo apt install python3 python3-venv; or name one: make demo PYTHON=/path/to/python3.12"
    exit 1
}

python=$(find_python)
version=$(version_of "$python")

if ! "$python" -c 'import venv, ensurepip' 2>/dev/null; then
    say "$python ($version) has no venv module."
    say "On Debian or Ubuntu: sudo apt install python$version-venv (or python3-venv), then run make again."
    exit 1
fi

if [ "$(version_of "$folder/bin/python")" != "$version" ]; then
    say "making $folder with $python ($version)"
    "$python" -m venv --clear "$folder"
fi

say "installing the locked packages of requirements/py$version.txt (about 2 GB on the disk; once)"
pip="$folder/bin/python -m pip --disable-pip-version-check --quiet"
$pip install --require-hashes --only-binary :all: --requirement "$here/py$version.txt"
$pip install --no-deps --no-build-isolation --editable "$here/.."
