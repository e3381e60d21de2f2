"""Whether VTK can draw a picture here: a sphere, off screen, in a process that may die of it."""

from __future__ import annotations

from typing import Any

from stackloft.cli.doctor.libraries import system_fix
from stackloft.cli.doctor.row import Row
from stackloft.registry.child import ask_child

SIZE = 64
"""Pixels on a side."""


def rendering() -> Row:
    """Return whether pictures of solids can be drawn here."""
    answer = ask_child("stackloft.cli.doctor.rendering:draw", None, 60.0)
    if not answer.fault and answer.value > 0:
        return Row("rendering", "off screen", "ok", f"a sphere covers {answer.value} of {SIZE * SIZE} pixels")
    _, fix = system_fix(answer.stderr)
    detail = f"drawing a sphere {answer.fault}" if answer.fault else "a sphere leaves the picture empty"
    fix = fix or "apt-get install xvfb libgl1, then: xvfb-run -a stackloft …"
    return Row("rendering", "off screen", "warning", f"not possible: {detail}", fix, answer.stderr)


def draw(_: Any) -> int:
    """Draw a white sphere on black in this process and return how many pixels it covers."""
    import vtkmodules.vtkRenderingOpenGL2  # noqa: F401, PLC0415 - registers the factory that draws
    from vtkmodules.util.numpy_support import vtk_to_numpy  # noqa: PLC0415
    from vtkmodules.vtkFiltersSources import vtkSphereSource  # noqa: PLC0415
    from vtkmodules.vtkRenderingCore import (  # noqa: PLC0415
        vtkActor,
        vtkPolyDataMapper,
        vtkRenderer,
        vtkRenderWindow,
        vtkWindowToImageFilter,
    )

    mapper, actor, renderer, window = vtkPolyDataMapper(), vtkActor(), vtkRenderer(), vtkRenderWindow()
    mapper.SetInputConnection(vtkSphereSource().GetOutputPort())
    actor.SetMapper(mapper)
    renderer.AddActor(actor)
    window.SetOffScreenRendering(True)
    window.SetSize(SIZE, SIZE)
    window.AddRenderer(renderer)
    window.Render()
    grab = vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.Update()
    levels = vtk_to_numpy(  # type: ignore[no-untyped-call]
        grab.GetOutput().GetPointData().GetScalars()
    )
    return int((levels.max(axis=1) > 10).sum())
