"""The built-in methods, and how far each may be off on a body it suits."""

from __future__ import annotations

from stackloft.contracts.recipe import Recipe
from stackloft.model.bias import Bias

_LOFTED = "corresponding points were joined wrongly, or an end lies elsewhere than was assumed"
_SHAPES = "thin parts of neighbouring sections do not overlap, or an end lies elsewhere than was assumed"
_LEVEL = "slices far apart make steps between them, and a level off the edge moves the surface"
_TRIANGLES = "triangles are coarse for the body's roundness, or parts of the surface overlap"
_FRUSTA = "frusta stop at the outermost sections, and their sides are too large between elongated ones"

loft = Recipe(
    steps=("reconstructor.loft", "integrator.surface-gauss"),
    summary="B-spline loft through the sections, closed at its ends, integrated by the divergence theorem; "
    "assumes a surface that is smooth across sections",
    volume_bias=Bias(-1.0, 1.0, _LOFTED),
    area_bias=Bias(-1.5, 1.5, _LOFTED),
)

shape_interpolation = Recipe(
    steps=("reconstructor.shape-interpolation", "integrator.polyhedral"),
    summary="signed distance of the sections, cubic between them (Raya & Udupa 1990); no points correspond; "
    "low where thin parts do not overlap, edges rounded",
    volume_bias=Bias(-1.5, 1.0, _SHAPES),
    area_bias=Bias(-2.0, 1.5, _SHAPES),
)

cavalieri = Recipe(
    steps=("integrator.cavalieri",),
    summary="section areas times pitch; volume only; with sections at mid-thickness high by 1/(2m²) "
    "on an ellipsoid of m sections",
)

frustum = Recipe(
    steps=("integrator.frustum",),
    summary="conical frusta between neighbouring sections (Sabliov et al. 2002; Zheng & Sun 2006); "
    "sees no more than each section's area and perimeter",
    volume_bias=Bias(-12.0, 1.0, _FRUSTA),
    area_bias=Bias(-10.0, 8.0, _FRUSTA),
)

voxel = Recipe(
    steps=("integrator.voxel",),
    summary="pixels above the level times slice length; volume only; across slices it errs as cavalieri does",
)

partial_volume = Recipe(
    steps=("integrator.partial-volume",),
    summary="sum of the grey levels' coverage; volume only; unbiased for one grey before another, off where "
    "the skin has another grey than the flesh",
)

crofton = Recipe(
    steps=("integrator.crofton",),
    summary="boundary crossings of lattice lines, directions weighted for the actual spacing (Legland et al. "
    "2007); low at sharp edges, high on noisy masks; the volume is the voxel count",
)

polyhedral = Recipe(
    steps=("integrator.polyhedral",),
    summary="a surface's triangles taken at their word, by signed sums; the default for STL, PLY and OBJ; "
    "low where triangles are inscribed in a round body",
    volume_bias=Bias(-1.5, 0.5, _TRIANGLES),
    area_bias=Bias(-1.5, 0.5, _TRIANGLES),
)

repair = Recipe(
    steps=("reconstructor.repair", "integrator.polyhedral"),
    summary="a surface mended by MeshLab (holes, crossing and turned triangles), then by its triangles; "
    "what the repair changed is told",
    volume_bias=Bias(-2.0, 2.0, _TRIANGLES),
    area_bias=Bias(-2.0, 2.0, _TRIANGLES),
)

isosurface = Recipe(
    steps=("reconstructor.isosurface", "integrator.polyhedral"),
    summary="the level's surface through the voxels (flying edges); high in area where slices are far apart "
    "and on label maps",
    volume_bias=Bias(-1.0, 1.0, _LEVEL),
    area_bias=Bias(-1.0, 10.0, _LEVEL),
)

fem = Recipe(
    steps=("reconstructor.loft", "mesher.sweep", "integrator.fem"),
    summary="the loft filled with curved tetrahedra of order 2, u = 1 integrated by Gauss rules of degree 4 "
    "(Goñi, Purlis & Salvadori 2007); what the loft says, within 2e-5",
    options={"mesher.sweep": {"order": 2}, "integrator.fem": {"degree": 4}},
    volume_bias=Bias(-1.0, 1.0, _LOFTED),
    area_bias=Bias(-1.5, 1.5, _LOFTED),
)

fem_tetwild = Recipe(
    steps=("reconstructor.loft", "mesher.tetwild", "integrator.fem"),
    summary="the loft, of any topology, filled with curved tetrahedra by fTetWild, its boundary put back "
    "on the loft; integrated by Gauss rules of degree 4",
    options={"mesher.tetwild": {"order": 2}, "integrator.fem": {"degree": 4}},
    slow=True,
    volume_bias=Bias(-1.0, 1.0, _LOFTED),
    area_bias=Bias(-1.5, 1.5, _LOFTED),
)

tetwild = Recipe(
    steps=("reconstructor.isosurface", "mesher.tetwild", "integrator.fem"),
    summary="the level's surface through the voxels filled with straight tetrahedra by fTetWild; errs as "
    "isosurface does, and low by what fTetWild's envelope cuts off",
    options={"mesher.tetwild": {"order": 1}},
    slow=True,
    volume_bias=Bias(-1.5, 1.0, _LEVEL),
    area_bias=Bias(-2.0, 10.0, _LEVEL),
)
