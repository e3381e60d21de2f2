"""A scan as ParaVision writes it: ``2dseq``, ``visu_pars`` and ``reco``."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from stackloft.model.arrays import FloatArray
from stackloft.testing.phantoms.files import write_whole
from stackloft.testing.phantoms.scan_volume import ScanVolume

_SLOPE, _OFFSET = 0.5, -1024.0


def write_bruker(volume: ScanVolume, folder: Path) -> list[Path]:
    """Write a reconstruction of two-dimensional frames into `folder`; return its three files.

    The numbers are 16 bits, little endian, two of them for each HU above -1024.
    """
    stored = np.stack(volume.slices).astype(np.float64)
    numbers = np.clip(np.round((stored - _OFFSET) / _SLOPE), -32768, 32767).astype("<i2")
    count = len(volume.slices)
    corners = np.array([volume.corner(k) for k in range(count)])
    text = visu_pars(
        VisuCoreFrameCount=count,
        VisuCoreDim=2,
        VisuCoreSize=np.array(volume.grid.shape[::-1]),
        VisuCoreDimDesc=["spatial", "spatial"],
        VisuCoreExtent=np.array(volume.grid.shape[::-1]) * np.array(volume.grid.spacing[::-1]),
        VisuCoreFrameThickness=np.array([volume.grid.thickness]),
        VisuCoreUnits=["<mm>", "<mm>"],
        VisuCoreOrientation=np.tile(volume.turn.T.ravel(), (count, 1)),
        VisuCorePosition=corners,
        VisuCoreDataOffs=np.full(count, _OFFSET),
        VisuCoreDataSlope=np.full(count, _SLOPE),
        VisuCoreFrameType="MAGNITUDE_IMAGE",
        VisuCoreWordType="_16BIT_SGN_INT",
        VisuCoreByteOrder="littleEndian",
        VisuCoreDiskSliceOrder="disk_normal_slice_order",
        VisuFGOrderDesc=[f"({count}, <FG_SLICE>, <>, 0, 2)"],
        VisuSubjectName="<Phantom^Grey>",
        VisuSubjectId="<PH-2007>",
    )
    reco = visu_pars(RECO_wordtype="_16BIT_SGN_INT", RECO_byte_order="littleEndian")
    return [
        write_whole(folder / "2dseq", numbers.tobytes()),
        write_whole(folder / "visu_pars", text.encode()),
        write_whole(folder / "reco", reco.encode()),
    ]


def visu_pars(**entries: str | int | list[str] | FloatArray) -> str:
    """Return a JCAMP-DX parameter file: arrays with their size, equal numbers as one run.

    Examples
    --------
    >>> print(visu_pars(Slope=np.array([2.0, 2.0]), Size=np.array([3, 4])).split("##END")[0].strip())
    ##TITLE=Parameter List, stackloft
    ##$Slope=( 2 )
    @2*(2.0)
    ##$Size=( 2 )
    3 4
    """
    lines = ["##TITLE=Parameter List, stackloft"]
    for name, value in entries.items():
        if isinstance(value, np.ndarray):
            sides = ", ".join(map(str, value.shape))
            flat = value.ravel().tolist()
            run = len(flat) > 1 and len(set(flat)) == 1
            lines += [
                f"##${name}=( {sides} )",
                f"@{len(flat)}*({flat[0]})" if run else " ".join(map(str, flat)),
            ]
        elif isinstance(value, list):
            lines += [f"##${name}=( {len(value)} )", " ".join(value)]
        else:
            lines.append(f"##${name}={value}")
    return "\n".join([*lines, "##END="]) + "\n"
