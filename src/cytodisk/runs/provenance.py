"""Where results come from: versions, inputs and their hashes, parameters, time."""

import platform
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from cytodisk.disk.mapping_parameters import MAPS_VERSION
from cytodisk.parameters import Parameters
from cytodisk.runs.versions import NUMERIC, installed
from cytodisk.scale import Scale
from cytodisk.store.inputs.input_hashes import described
from cytodisk.store.provenance_file import MAPS


def describe_run(
    inputs: Mapping[str, Path | Sequence[Path]],
    parameters: Parameters,
    understood: Mapping[str, str],
    scale: Scale,
    notes: Sequence[str] = (),
    given: Mapping[str, str] | None = None,
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
    notes : sequence of str
        What is wrong with the files; the first of the warnings.
    given : dict of role to str, optional
        What the user gave where that is not the path itself, as "_img" for images in the folder of masks.

    Returns
    -------
    dict
        Its "fingerprint" holds all that the results depend on.

    Raises
    ------
    ReadError
        An input cannot be read.
    """
    found_by_role = {role: described(paths) for role, paths in inputs.items()}
    settings = parameters.model_dump(mode="json")
    fingerprint: dict[str, Any] = {f"{role} sha256": found["sha256"] for role, found in found_by_role.items()}
    fingerprint |= {"cytodisk": installed(("cytodisk",))["cytodisk"]} | settings
    fingerprint |= {MAPS: MAPS_VERSION, "packages": installed(NUMERIC)}
    fingerprint |= asdict(scale)
    return {
        "status": "running",
        "fingerprint": fingerprint,
        "inputs": {
            role: found | {"read as": understood[role]} | _as_given(role, found, given or {})
            for role, found in found_by_role.items()
        },
        "parameters": settings,
        **asdict(scale),
        "length_unit": scale.length_unit,
        "velocity_unit": scale.velocity_unit,
        "versions": installed(),
        "python": platform.python_version(),
        "platform": platform.platform(),
        "seed": settings.get("seed"),  # of the error bar of edge velocity; nothing else is random
        "started": datetime.now(UTC).isoformat(timespec="seconds"),
        "warnings": list(notes),
    }


def _as_given(role: str, found: Mapping[str, Any], given: Mapping[str, str]) -> dict[str, str]:
    return {"given": given[role]} if given.get(role, found["path"]) != found["path"] else {}
