"""The house's plan as failing checks."""

import subprocess
import sys
import tomllib
from importlib.metadata import distribution, requires
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
TOOLS = Path(sys.executable).parent
HEAVY = (
    *("vtk", "vtkmodules", "pyvista", "pymeshlab", "pytetwild", "SimpleITK", "matplotlib", "cv2", "skimage"),
    *("scipy", "numpy", "pydicom", "PIL", "tifffile", "meshio", "pydantic", "stackloft_plugins"),
)


def imported_by(code):
    """Return which heavy packages a fresh interpreter has loaded after running `code`."""
    script = f"{code}\nimport sys\nprint(*[name for name in {HEAVY!r} if name in sys.modules])"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    return set(done.stdout.splitlines()[-1].split())


def run_tool(name, *arguments):
    tool = TOOLS / name
    if not tool.exists():
        pytest.skip(f"{name} is not installed here")
    return subprocess.run([tool, *arguments], cwd=ROOT, capture_output=True, text=True, check=False)


def test_arrows_run_one_way():
    done = run_tool("lint-imports", "--no-cache")
    assert done.returncode == 0, done.stdout + done.stderr


def test_dependencies_are_declared_and_used():
    done = run_tool("deptry", "core", "plugins")
    assert done.returncode == 0, done.stdout + done.stderr


def test_installed_entry_points_are_those_of_pyproject():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    written = {
        (group, name, target)
        for group, names in project["entry-points"].items()
        for name, target in names.items()
    } | {("console_scripts", name, target) for name, target in project["scripts"].items()}
    installed = {(x.group, x.name, x.value) for x in distribution("stackloft").entry_points}
    assert installed == written, "entry points are written at install: run `make` or pip install -e . again"


def test_the_card_s_packages_are_dependencies():
    required = {
        line.split(">")[0].split("[")[0].lower() for line in requires("stackloft") if "extra" not in line
    }
    assert {"pydicom", "simpleitk", "scikit-image", "numpy", "scipy", "pymeshlab", "pytetwild"} <= required


@pytest.mark.parametrize(
    "code",
    [
        "import stackloft",
        "import stackloft; stackloft.__version__; dir(stackloft)",
        "import stackloft; stackloft.StackloftError, stackloft.UsageError, stackloft.End",
        "import stackloft.registry as r; assert r.catalogue()",
        "import stackloft.registry as r; r.locate('reader', 'photos')",
        "import stackloft.contracts.families, stackloft.contracts.options, stackloft.contracts.recipe",
    ],
)
def test_nothing_heavy_is_imported(code):
    assert imported_by(code) == set()


def test_loading_a_recipe_imports_the_recipes_alone():
    found = imported_by("import stackloft.registry as r; r.find('recipe', 'loft')")
    assert found == {"stackloft_plugins"}


def test_measuring_contours_needs_no_picture_or_mesh_package():
    code = """
import numpy as np, stackloft
ring = 10 * np.column_stack([np.cos(t := np.linspace(0, 6.283185307, 40, endpoint=False)), np.sin(t)])
sections = tuple(stackloft.Section(5.0 * k, (stackloft.Loop(ring),), str(k)) for k in range(5))
stackloft.measure(stackloft.ContourStack(sections), ends="face")
"""
    assert imported_by(code) <= {"numpy", "scipy", "pydantic", "stackloft_plugins"}


def test_every_public_name_is_there():
    import stackloft  # noqa: PLC0415

    assert all(getattr(stackloft, name) is not None for name in stackloft.__all__)
    assert set(stackloft.__all__) <= set(dir(stackloft))
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        stackloft.nothing  # noqa: B018


def test_no_file_outgrows_the_house():
    sizes = {
        path.relative_to(ROOT).as_posix(): len(path.read_text(encoding="utf-8").splitlines())
        for root in ("core", "plugins")
        for path in (ROOT / root).rglob("*.py")
    }
    assert {name: lines for name, lines in sizes.items() if lines > 250} == {}
