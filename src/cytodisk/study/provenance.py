"""Where results come from: versions, inputs and their hashes, parameters, time."""

import hashlib
import platform
from collections.abc import Mapping
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from cytodisk.errors import ReadError
from cytodisk.motion.velocity import velocity_unit
from cytodisk.study.parameters import MapParameters

PACKAGES = (
    "cytodisk",
    "numpy",
    "scipy",
    "numba",
    "pythoncdt",
    "qdldl",
    "shapely",
    "scikit-image",
    "tifffile",
    "xarray",
    "zarr",
    "SimpleITK",
    "laptrack",
)


_NUMERIC = ("numpy", "scipy", "numba", "pythoncdt", "qdldl", "shapely", "scikit-image", "SimpleITK")


def installed(packages: tuple[str, ...] = PACKAGES) -> dict[str, str]:
    """Version of each package, "not installed" where it is missing."""
    found = {}
    for name in packages:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            found[name] = "not installed"
    return found


def describe_run(
    inputs: Mapping[str, Path],
    parameters: MapParameters,
    understood: Mapping[str, str],
    pixel_size_um: float | None,
    frame_interval_s: float | None = None,
) -> dict[str, Any]:
    """Provenance of a run that starts now.

    Parameters
    ----------
    inputs : dict of role to Path
        As "masks" and "signal".
    parameters : MapParameters
    understood : dict of role to str
        What each input was read as, in words.
    pixel_size_um : float or None
        The scale that the results are in.
    frame_interval_s : float or None

    Returns
    -------
    dict
        Its "fingerprint" holds all that the results depend on.

    Raises
    ------
    ReadError
        An input cannot be read.
    """
    hashes = {role: _sha256(path) for role, path in inputs.items()}
    settings = parameters.model_dump(mode="json")
    fingerprint: dict[str, Any] = {f"{role} sha256": value for role, value in hashes.items()}
    fingerprint |= {"cytodisk": installed(("cytodisk",))["cytodisk"]} | settings
    fingerprint["packages"] = installed(_NUMERIC)
    fingerprint |= {"pixel_size_um": pixel_size_um, "frame_interval_s": frame_interval_s}
    return {
        "status": "running",
        "fingerprint": fingerprint,
        "inputs": {
            role: {"path": str(path), "sha256": hashes[role], "read as": understood[role]}
            for role, path in inputs.items()
        },
        "parameters": settings,
        "pixel_size_um": pixel_size_um,
        "frame_interval_s": frame_interval_s,
        "length_unit": "px" if pixel_size_um is None else "µm",
        "velocity_unit": velocity_unit(pixel_size_um, frame_interval_s),
        "versions": installed(),
        "python": platform.python_version(),
        "platform": platform.platform(),
        "seed": settings.get("seed"),  # of the error bar of edge velocity; nothing else is random
        "started": datetime.now(UTC).isoformat(timespec="seconds"),
        "warnings": [],
    }


def _sha256(path: Path) -> str:
    try:
        with path.open("rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except OSError as error:
        raise ReadError(f"{path} cannot be read: {error.strerror}") from error
