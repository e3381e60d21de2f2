"""What tests that compile need."""

import subprocess

import pytest

from stackloft.compiled import building


@pytest.fixture(scope="session")
def c_compiler(tmp_path_factory):
    """Skip where no C compiler is here, or one that cannot even compile three lines (no libc6-dev)."""
    command = building.compiler()
    if command is None:
        pytest.skip("no C compiler here")
    folder = tmp_path_factory.mktemp("probe")
    source = folder / "probe.c"
    source.write_text(
        "#include <math.h>\ndouble root(double x);\ndouble root(double x) { return sqrt(x); }\n"
    )
    flags = ("-shared", "-fPIC", "-o", folder / "probe.so")
    done = subprocess.run([*command, *flags, source, "-lm"], capture_output=True, text=True, check=False)
    if done.returncode or not (folder / "probe.so").exists():
        pytest.skip(f"{' '.join(command)} does not work here: {done.stderr}")
