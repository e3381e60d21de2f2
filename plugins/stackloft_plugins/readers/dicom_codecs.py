"""Which packages decode a transfer syntax, and what to say when none is there."""

from __future__ import annotations

from pathlib import Path

from stackloft.model.errors import InputError
from stackloft_plugins.readers.dicom_file import safely

PACKAGES: dict[str, tuple[str, ...]] = {
    "1.2.840.10008.1.2.4.50": ("pylibjpeg-libjpeg", "python-gdcm"),
    "1.2.840.10008.1.2.4.51": ("pylibjpeg-libjpeg", "python-gdcm"),
    "1.2.840.10008.1.2.4.57": ("pylibjpeg-libjpeg", "python-gdcm"),
    "1.2.840.10008.1.2.4.70": ("pylibjpeg-libjpeg", "python-gdcm"),
    "1.2.840.10008.1.2.4.80": ("pyjpegls", "pylibjpeg-libjpeg", "python-gdcm"),
    "1.2.840.10008.1.2.4.81": ("pyjpegls", "pylibjpeg-libjpeg", "python-gdcm"),
    "1.2.840.10008.1.2.4.90": ("pylibjpeg-openjpeg", "python-gdcm"),
    "1.2.840.10008.1.2.4.91": ("pylibjpeg-openjpeg", "python-gdcm"),
    "1.2.840.10008.1.2.4.201": ("pylibjpeg-openjpeg",),
    "1.2.840.10008.1.2.4.202": ("pylibjpeg-openjpeg",),
    "1.2.840.10008.1.2.4.203": ("pylibjpeg-openjpeg",),
}
"""Transfer syntax to the packages that decode it, the first being the one to install."""


def check_decoder(syntax: str, path: Path) -> None:
    """Raise InputError unless the pixels of a transfer syntax can be decoded here.

    Raises
    ------
    InputError
        Names the transfer syntax, the decoders that would serve, and the pip line.

    Examples
    --------
    >>> check_decoder("1.2.840.10008.1.2.1", Path("a.dcm"))
    >>> check_decoder("1.2.840.10008.1.2.4.100", Path("a.dcm"))
    Traceback (most recent call last):
    stackloft.model.errors.InputError: a.dcm: no decoder knows its transfer syntax; \
found: MPEG2 Main Profile / Main Level (1.2.840.10008.1.2.4.100); \
fix: export the series uncompressed (Explicit VR Little Endian)
    """
    found, usable = _known(syntax, path)
    if usable is None:
        raise InputError(
            "no decoder knows its transfer syntax",
            where=str(path),
            found=found,
            fix="export the series uncompressed (Explicit VR Little Endian)",
        )
    if not usable:
        packages = PACKAGES.get(syntax, ("python-gdcm",))
        raise InputError(
            "no decoder for its transfer syntax is installed",
            where=str(path),
            found=found,
            expected=f"one of {', '.join(packages)}",
            fix=f"python -m pip install {packages[0]}",
        )


def _known(syntax: str, path: Path) -> tuple[str, bool | None]:
    """Return the syntax in words, and whether it can be decoded; None where no decoder knows it."""
    from pydicom.pixels.decoders.base import get_decoder  # noqa: PLC0415 - slow to import
    from pydicom.uid import UID  # noqa: PLC0415

    with safely(path, "its transfer syntax"):
        named = UID(syntax)
        found = f"{named.name} ({syntax})" if named.is_transfer_syntax else "no transfer syntax of DICOM"
        try:
            return found, get_decoder(named).is_available
        except NotImplementedError:
            return found, None
    raise AssertionError  # `safely` lets nothing through
