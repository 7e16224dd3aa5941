"""Where results come from: versions, inputs and their hashes, parameters, time."""

import hashlib
import platform
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from cytodisk.disk.mapping_parameters import MAPS_VERSION
from cytodisk.errors import ReadError
from cytodisk.images.image_paths import sha256_of
from cytodisk.parameters import Parameters
from cytodisk.runs.versions import NUMERIC, installed
from cytodisk.scale import Scale
from cytodisk.store.provenance_file import MAPS


def describe_run(
    inputs: Mapping[str, Path | Sequence[Path]],
    parameters: Parameters,
    understood: Mapping[str, str],
    scale: Scale,
) -> dict[str, Any]:
    """Provenance of a run that starts now.

    Parameters
    ----------
    inputs : dict of role to Path, or to a sequence of Path
        As "masks" and "signal"; a sequence for files of one folder.
    parameters : Parameters
    understood : dict of role to str
        What each input was read as, in words.
    scale : Scale
        That the results are in.

    Returns
    -------
    dict
        Its "fingerprint" holds all that the results depend on.

    Raises
    ------
    ReadError
        An input cannot be read.
    """
    described = {role: _describe_input(paths) for role, paths in inputs.items()}
    settings = parameters.model_dump(mode="json")
    fingerprint: dict[str, Any] = {f"{role} sha256": found["sha256"] for role, found in described.items()}
    fingerprint |= {"cytodisk": installed(("cytodisk",))["cytodisk"]} | settings
    fingerprint |= {MAPS: MAPS_VERSION, "packages": installed(NUMERIC)}
    fingerprint |= asdict(scale)
    return {
        "status": "running",
        "fingerprint": fingerprint,
        "inputs": {role: found | {"read as": understood[role]} for role, found in described.items()},
        "parameters": settings,
        **asdict(scale),
        "length_unit": scale.length_unit,
        "velocity_unit": scale.velocity_unit,
        "versions": installed(),
        "python": platform.python_version(),
        "platform": platform.platform(),
        "seed": settings.get("seed"),  # of the error bar of edge velocity; nothing else is random
        "started": datetime.now(UTC).isoformat(timespec="seconds"),
        "warnings": [],
    }


def _describe_input(paths: Path | Sequence[Path]) -> dict[str, Any]:
    if isinstance(paths, Path):
        return {"path": str(paths), "sha256": _sha256(paths)}
    files = {path.name: _sha256_if_readable(path) for path in paths}
    lines = "".join(f"{value}  {name}\n" for name, value in files.items())
    whole = hashlib.sha256(lines.encode()).hexdigest()
    return {"path": str(paths[0].parent), "sha256": whole, "files": files}


def _sha256_if_readable(path: Path) -> str:
    """A file of many that cannot be read has its row in the results, so it does not stop the run here."""
    try:
        return _sha256(path)
    except ReadError:
        return "unreadable"


def _sha256(path: Path) -> str:
    try:
        return sha256_of(path)
    except OSError as error:
        raise ReadError(f"{path} cannot be read: {error.strerror}") from error
