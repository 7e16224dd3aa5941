"""`cytodisk info`."""

import platform
from importlib.util import find_spec

from cytodisk.errors import install_words
from cytodisk.runs.versions import NOT_INSTALLED, PACKAGES, PARTS, installed

_FORMATS = "TIFF, OME-TIFF, ImageJ TIFF, PNG, OME-Zarr, GeoJSON, with extras ND2, CZI, LIF, ROI"


def info_command() -> None:
    print(f"python\t{platform.python_version()} on {platform.platform()}")
    optional = {name for packages in PARTS.values() for name in packages}
    for name, number in installed(PACKAGES).items():
        if name not in optional:
            print(f"{name}\t{number}")
    for part, packages in PARTS.items():
        print(f"{part}\t{_part_words(part, installed(packages))}")
    print(f"image formats\t{_FORMATS}")
    print(f"compressed TIFF\t{'yes' if find_spec('imagecodecs') else 'no: pip install imagecodecs'}")


def _part_words(part: str, found: dict[str, str]) -> str:
    words = ", ".join(f"{name} {number}" for name, number in found.items())
    if NOT_INSTALLED not in found.values():
        return words
    return f"{words}: {install_words(part)}"
