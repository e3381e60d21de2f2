"""``stackloft mesh``: a solid or tetrahedra in the format of the file's suffix, whole or not at all."""

import math

import meshio
import numpy as np
import pytest
from typer.testing import CliRunner

from stackloft.cli.app import app
from stackloft.geometry.tet_integrals import elements_volume

BALL = 4 / 3 * math.pi * 20**3


@pytest.fixture(scope="module")
def ball(tmp_path_factory):
    """A ball of radius 20 mm as a table of exact contours."""
    rows = ["section,z,loop,x,y"]
    angles = np.linspace(0, 2 * np.pi, 60, endpoint=False)
    for k, z in enumerate(np.linspace(-18.0, 18.0, 10)):
        r = math.sqrt(400 - z * z)
        rows += [f"{k + 1},{z!r},1,{r * math.cos(a)!r},{r * math.sin(a)!r}" for a in angles]
    path = tmp_path_factory.mktemp("ball") / "ball.csv"
    path.write_text("\n".join(rows).replace("np.float64(", "").replace(")", "") + "\n")
    return path


def run(*arguments):
    return CliRunner().invoke(app, ["mesh", *map(str, arguments)])


@pytest.mark.parametrize("suffix", ["vtu", "msh", "inp"])
def test_tetrahedra_by_suffix(ball, suffix, tmp_path):
    path = tmp_path / f"ball.{suffix}"
    done = run(ball, "-o", path, "--height", "40mm", "--units", "mm")
    assert done.exit_code == 0, done.output
    for told in ("tetrahedra of order 2", "smallest scaled Jacobian", "0 elements turned over", "; loft "):
        assert told in done.stdout
    back = meshio.read(path)
    volume = elements_volume(back.points, back.cells_dict["tetra10"], 4)
    assert volume == pytest.approx(BALL, rel=2e-3)
    assert [item.name for item in tmp_path.iterdir()] == [path.name]


def test_options_reach_the_mesher(ball, tmp_path):
    path = tmp_path / "ball.msh"
    done = run(ball, "-o", path, "--order", "1", "--mesher", "sweep", "--set", "mesher.elements=800")
    assert done.exit_code == 0, done.output
    assert "of order 1" in done.stdout
    assert len(meshio.read(path).cells_dict["tetra"]) <= 800


@pytest.mark.parametrize("suffix", ["stl", "ply", "obj"])
def test_surfaces_by_suffix(ball, suffix, tmp_path):
    path = tmp_path / f"ball.{suffix}"
    done = run(ball, "-o", path, "--set", f"{suffix}.tolerance=0.2mm")
    assert done.exit_code == 0, done.output
    assert "triangles" in done.stdout
    assert len(meshio.read(path).cells_dict["triangle"]) > 100


@pytest.mark.parametrize(
    ("arguments", "status", "told"),
    [
        (("-o", "{}/a.xyz"), 2, "found: .xyz; expected: .inp, .mphtxt, .msh, .obj, .ply, .stl, .vtu"),
        (("-o", "{}/a"), 2, "no suffix"),
        (("-o", "{}/gone/a.vtu"), 2, "no such folder"),
        (("-o", "{}/a.stl", "--order", "2"), 2, "holds a surface"),
        (("-o", "{}/a.vtu", "--mesher", "swep"), 1, "swep"),
        (("-o", "{}/a.vtu", "--order", "4"), 2, "order"),
        (("-o", "{}/a.msh", "--order", "3"), 1, "fix: give --order 2"),
        (("-o", "{}/a.vtu", "--object", "all"), 2, "one body"),
    ],
)
def test_what_cannot_be_is_said_in_one_line_and_nothing_is_written(ball, arguments, status, told, tmp_path):
    done = run(ball, *(word.format(tmp_path) for word in arguments))
    assert done.exit_code == status, done.output
    line = done.stderr.splitlines()[-1]
    assert told in line
    assert list(tmp_path.iterdir()) == []


def test_measure_writes_tetrahedra_when_the_method_makes_them(ball, tmp_path):
    done = CliRunner().invoke(
        app, ["measure", str(ball), "--method", "fem", "--out", str(tmp_path / "o"), "--write", "vtu,stl"]
    )
    assert done.exit_code == 0, done.output
    assert (tmp_path / "o" / "solid.vtu").stat().st_size > 1000
    assert (tmp_path / "o" / "solid.stl").exists()
    done = CliRunner().invoke(app, ["measure", str(ball), "--out", str(tmp_path / "p"), "--write", "vtu"])
    assert done.exit_code == 1
    assert "measure with --method fem" in done.stderr
