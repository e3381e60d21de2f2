"""Which DICOM transfer syntaxes can be decoded here, and what to install for the others."""

from __future__ import annotations

from typing import Any

from stackloft.cli.doctor.row import Row
from stackloft.registry.child import ask_child

_JPEG = "pylibjpeg pylibjpeg-libjpeg"
_JPEG_2000 = "pylibjpeg pylibjpeg-openjpeg"
PACKAGES = {
    **dict.fromkeys(("50", "51", "57", "70"), _JPEG),
    **dict.fromkeys(("80", "81"), "pyjpegls"),
    **dict.fromkeys(("90", "91", "201", "202", "203"), _JPEG_2000),
}
"""What to install for 1.2.840.10008.1.2.4.*, by the last number."""
_JPEG_UIDS = "1.2.840.10008.1.2.4."


def transfer_syntaxes() -> list[Row]:
    """Return a row for each transfer syntax that pydicom has a decoder for, found in a child process."""
    answer = ask_child("stackloft.cli.doctor.codecs:decodable")
    if answer.fault:
        fix = "python -m pip install --force-reinstall pydicom"
        return [
            Row("transfer syntax", "all", "broken", f"importing pydicom {answer.fault}", fix, answer.stderr)
        ]
    return [_row(*said) for said in answer.value]


def _row(uid: str, name: str, plugins: list[str], missing: list[str]) -> Row:
    if plugins:
        return Row("transfer syntax", uid, "ok", f"{name}: {', '.join(plugins)}")
    package = PACKAGES.get(uid.removeprefix(_JPEG_UIDS), "python-gdcm")
    detail = f"{name}: no decoder ({'; '.join(missing) or 'none installed'})"
    return Row("transfer syntax", uid, "broken", detail, f"python -m pip install {package}")


def decodable(_: Any) -> list[tuple[str, str, list[str], list[str]]]:
    """Return UID, name, usable decoders and what is missing, of each transfer syntax with pixels.

    Uncompressed syntaxes are decoded by pydicom itself.
    """
    from pydicom.pixels.decoders.base import get_decoder  # noqa: PLC0415 - slow to import
    from pydicom.uid import AllTransferSyntaxes  # noqa: PLC0415

    rows = []
    for uid in AllTransferSyntaxes:
        try:
            decoder = get_decoder(uid)
        except NotImplementedError:
            continue
        plain = [] if uid.is_encapsulated else ["pydicom itself"]
        usable = plain or list(decoder.available_plugins)
        rows.append((str(uid), str(uid.name), usable, list(decoder.missing_dependencies)))
    return rows
