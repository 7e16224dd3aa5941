"""cytodisk: any cell, any moment, one disk."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from cytodisk import errors as errors
    from cytodisk import simulate as simulate
    from cytodisk.disk.certificate import Certificate as Certificate
    from cytodisk.disk.certificate import certify as certify
    from cytodisk.disk.disk_map import DiskMap as DiskMap
    from cytodisk.disk.disk_map import load_map as load_map
    from cytodisk.disk.distortion import Distortion as Distortion
    from cytodisk.disk.mapping import map_to_disk as map_to_disk
    from cytodisk.geometry.mask import MaskReport as MaskReport
    from cytodisk.geometry.mask import clean_mask as clean_mask
    from cytodisk.io.frames import read_image as read_image
    from cytodisk.io.study_folder import Study as Study
    from cytodisk.io.study_folder import open_study as open_study
    from cytodisk.windows.cell_windows import CellWindows as CellWindows
    from cytodisk.windows.grid import PolarWindows as PolarWindows
    from cytodisk.windows.grid import polar_windows as polar_windows
    from cytodisk.windows.sample import sample as sample

__version__ = "0.1.0"

_HOME = {
    "Certificate": "disk.certificate",
    "CellWindows": "windows.cell_windows",
    "DiskMap": "disk.disk_map",
    "Distortion": "disk.distortion",
    "MaskReport": "geometry.mask",
    "PolarWindows": "windows.grid",
    "Study": "io.study_folder",
    "certify": "disk.certificate",
    "clean_mask": "geometry.mask",
    "load_map": "disk.disk_map",
    "map_to_disk": "disk.mapping",
    "open_study": "io.study_folder",
    "polar_windows": "windows.grid",
    "read_image": "io.frames",
    "sample": "windows.sample",
}
_MODULES = ("errors", "simulate")

__all__ = sorted([*_HOME, *_MODULES])


def __getattr__(name: str) -> Any:
    if name in _MODULES:
        return import_module(f"cytodisk.{name}")
    if name in _HOME:
        return getattr(import_module(f"cytodisk.{_HOME[name]}"), name)
    raise AttributeError(f"module 'cytodisk' has no attribute {name!r}")


def __dir__() -> list[str]:
    return [*__all__, "__version__"]
