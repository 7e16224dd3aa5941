"""Open the files again that a study of single cells was made from."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from cytodisk.errors import CytodiskError
from cytodisk.files import file_name
from cytodisk.images.image_paths import is_pattern
from cytodisk.runs.cells.cell_inputs import CellInputs, open_inputs
from cytodisk.runs.cells.cell_parameters import FileParameters
from cytodisk.store.inputs.input_hashes import described
from cytodisk.store.study import Study


@dataclass(frozen=True)
class FoundInputs:
    """The masks and images of a study.

    Attributes
    ----------
    inputs : CellInputs or None
        None if they cannot be used.
    fault : str
        Why not.
    """

    inputs: CellInputs | None
    fault: str = ""


def find_inputs(study: Study) -> FoundInputs:
    """Open the masks and images that a study of `cytodisk map` names, if they still hold what was measured.

    Parameters
    ----------
    study : Study

    Returns
    -------
    FoundInputs
        A relative path is looked up from the current folder, then from the study's and the one around it.
        Nuclei are not opened: the maps hold their outlines.
    """
    told = study.provenance.get("inputs", {})
    masks = told.get("masks", {})
    name = str(masks.get("given") or masks.get("path"))
    for base in _bases(study, name):
        if not ((base / name).exists() or is_pattern(base / name)):
            continue
        try:
            inputs = open_inputs(base / name, _beside(base, told.get("signal")), _parameters(study))
            fault = next(_changes(inputs, told), "")
        except (CytodiskError, OSError) as error:
            return FoundInputs(None, str(error))
        return FoundInputs(None, fault) if fault else FoundInputs(inputs)
    return FoundInputs(None, f"{file_name(name)} is not there any more")


def _bases(study: Study, name: str) -> tuple[Path, ...]:
    return (Path(),) if Path(name).is_absolute() else (Path(), study.path.parent, study.path)


def _beside(base: Path, told: Mapping[str, Any] | None) -> str | Path | None:
    """What was given as the signal: a path, or an ending of names, which stays as it is."""
    if not told:
        return None
    name = str(told.get("given") or told["path"])
    return base / name if (base / name).exists() or len(Path(name).parts) > 1 else name


def _parameters(study: Study) -> FileParameters:
    settings = study.provenance["parameters"]
    return FileParameters.of(
        **{name: settings[name] for name in FileParameters.model_fields if name in settings}
    )


def _changes(inputs: CellInputs, told: Mapping[str, Any]) -> Iterator[str]:
    """Files that hold something else than what was measured, in words."""
    for role, paths in inputs.paths.items():
        there, before = described(paths), told.get(role, {})
        if there["sha256"] == before.get("sha256"):
            continue
        now, then = there.get("files", {}), before.get("files", {})
        other = sorted(name for name in {*now, *then} if now.get(name) != then.get(name))
        name = other[0] if other else file_name(str(before.get("path", there["path"])))
        more = f" and {len(other) - 1} more do not" if len(other) > 1 else " does not"
        yield f"{name}{more} hold what was measured (the sha256 differs)"
