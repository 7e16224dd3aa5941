"""The studies of a population: those of a batch, of a list of folders, or one."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, TypeAlias

import pandas as pd
import pyarrow.parquet as pq

from cytodisk.errors import PopulationError, ReadError
from cytodisk.files import real_path
from cytodisk.images.mask_names import natural_order
from cytodisk.reading_files import reading_file
from cytodisk.runs.batch.input_row import STUDIES
from cytodisk.runs.population.opening.noted_cells import LeftOut
from cytodisk.store.populations.population_study import RUN as POPULATION
from cytodisk.store.provenance_file import PROVENANCE, read_complete, read_provenance

Paths: TypeAlias = str | os.PathLike[str] | Sequence[str | os.PathLike[str]]

_KINDS = ("map", "movie", "shapes")
_SHOWN = 3


@dataclass(frozen=True)
class FoundStudy:
    """A complete study.

    Attributes
    ----------
    name : str
        Of its input in the batch, or of its folder; no other study has it.
    folder : Path
    provenance : dict
    own : DataFrame, optional
        The user's columns in a batch, by number of the cell.
    """

    name: str
    folder: Path
    provenance: dict[str, Any]
    own: pd.DataFrame | None = field(default=None, compare=False)

    @property
    def run(self) -> str:
        """Its kind: "map", "movie" or "shapes"."""
        return str(self.provenance["run"])

    @property
    def parameters(self) -> dict[str, Any]:
        """What decided its results, beside the files."""
        found = self.provenance.get("parameters")
        return found if isinstance(found, dict) else {}

    @property
    def has_nuclei(self) -> bool:
        """Whether a file of nuclei was given."""
        return "nuclei" in self.provenance.get("inputs", {})

    @property
    def length_unit(self) -> str:
        """Unit of its lengths."""
        return str(self.provenance.get("length_unit", "px"))


def find_studies(path: Paths) -> tuple[list[FoundStudy], LeftOut]:
    """Studies in a folder or in several.

    Parameters
    ----------
    path : path-like, or sequence of path-like
        A study, a batch, or a folder that holds studies side by side; or several of these.

    Returns
    -------
    studies : list of FoundStudy
        With different names.
    left_out : LeftOut
        Inputs of batches that have no study.

    Raises
    ------
    PopulationError
        Nothing is there, a run is not complete, or a study is given twice.
    """
    given = [path] if isinstance(path, str | os.PathLike) else list(path)
    if not given:
        raise PopulationError("path is an empty list: pass folders of studies, such as ['day1', 'day2']")
    if wrong := [one for one in given if not isinstance(one, str | os.PathLike)]:
        raise PopulationError(f"path must be folders of studies, got {wrong[0]!r}: pass their names")
    left_out = LeftOut()
    several = len(given) > 1
    groups = [_studies_of(Path(one), left_out, several) for one in given]
    studies = _with_own_names([study for group in groups for study in group])
    if not studies:
        raise PopulationError(
            f"no input of {given[0]} has a study{_reasons(left_out)}: mend the inputs and run the batch again"
        )
    _refuse_twice(studies)
    return studies, left_out


def _studies_of(folder: Path, left_out: LeftOut, several: bool) -> list[FoundStudy]:
    """Studies of one folder."""
    if not folder.exists():
        raise PopulationError(f"{folder} does not exist: check the path")
    if not folder.is_dir():
        raise PopulationError(f"{folder} is a file: pass the folder of a study, or of a batch")
    if not (folder / PROVENANCE).exists():
        return _side_by_side(folder)
    provenance = _complete(folder, *_KINDS, "batch")
    if provenance["run"] == "batch":
        return _of_batch(folder, provenance, left_out, several)
    return [FoundStudy(folder.resolve().name, folder, provenance)]


def _complete(folder: Path, *runs: str) -> dict[str, Any]:
    try:
        return read_complete(folder, *runs)
    except ReadError as error:
        raise PopulationError(str(error)) from error


def _side_by_side(folder: Path) -> list[FoundStudy]:
    """Studies in the folders of a folder; a population that was written there is none of its inputs."""
    inner = sorted((one for one in folder.iterdir() if one.is_dir()), key=lambda one: natural_order(one.name))
    studies = [one for one in inner if (one / PROVENANCE).exists() and not _is_population(one)]
    if not studies:
        what = "is empty" if not any(folder.iterdir()) else f"has no {PROVENANCE}, nor has a folder in it"
        raise PopulationError(
            f"{folder} {what}: it is no study; pass what cytodisk map, movie, shapes or batch wrote as its -o"
        )
    return [FoundStudy(one.name, one, _complete(one, *_KINDS)) for one in studies]


def _is_population(folder: Path) -> bool:
    return bool((read_provenance(folder) or {}).get("run") == POPULATION)


def _of_batch(folder: Path, batch: dict[str, Any], left_out: LeftOut, several: bool) -> list[FoundStudy]:
    """Studies of a batch's inputs, in the order of the batch file."""
    columns = [str(name) for name in batch.get("columns", [])]
    if "replicate" in columns and "experiment" not in columns:
        raise PopulationError(
            f"batch {folder} has a column replicate, which is called experiment now: rename it in the batch "
            "file and run cytodisk batch again with --overwrite"
        )
    inputs = _merged(folder, "inputs", ["input", "status", "reason", "masks"])
    own = _own_columns(folder, columns) if columns else {}
    studies = []
    before = f"{folder.resolve().name}/" if several else ""
    for row in inputs.to_dict("records"):
        name, status = str(row["input"]), row["status"]
        inside = folder / STUDIES / name
        if (inside / PROVENANCE).exists() and status in ("ok", "refused"):
            studies.append(FoundStudy(before + name, inside, _complete(inside, *_KINDS), own.get(name)))
        elif status == "ok":
            raise PopulationError(
                f"input {name} of batch {folder} is done, but {inside} is gone: run the same command again "
                "with --resume"
            )
        else:
            left_out.add(before + name, f"{status}: {row['reason']}", source=row["masks"] or "")
    return studies


def _own_columns(folder: Path, columns: list[str]) -> dict[str, pd.DataFrame]:
    """The user's columns by input and number of the cell: of a cell in several frames, those of the first."""
    table = _merged(folder, "cells", ["input", "cell", *columns])
    table = table[~table[["input", "cell"]].duplicated()]
    return {str(name): rows.set_index("cell")[columns] for name, rows in table.groupby("input", sort=False)}


def _merged(folder: Path, name: str, columns: list[str]) -> pd.DataFrame:
    """Some columns of a merged table of a batch."""
    path = folder / f"{name}.parquet"
    with reading_file(path, "a merged table of a batch", "run the same command again with --resume"):
        found: pd.DataFrame = pq.read_table(path, columns=columns).to_pandas()
        if missing := [column for column in columns if column not in found]:
            raise ReadError(
                f"{path}: column {missing[0]} is missing: run the same command again with --resume"
            )
        return found


def _reasons(left_out: LeftOut) -> str:
    rows = left_out.rows[:_SHOWN]
    return f" ({'; '.join(str(row['reason']) for row in rows)})" if rows else ""


def _with_own_names(studies: list[FoundStudy]) -> list[FoundStudy]:
    """Studies whose names are alike get as much of their path as tells them apart."""
    names = Counter(study.name for study in studies)
    alike = [study for study in studies if names[study.name] > 1]
    if not alike:
        return studies
    parts = {id(study): study.folder.resolve().parts for study in alike}
    for length in range(2, max(map(len, parts.values())) + 1):
        longer = {key: "/".join(found[-length:]) for key, found in parts.items()}
        if len({*longer.values()}) == len({*parts.values()}):
            break
    return [replace(study, name=longer.get(id(study), study.name)) for study in studies]


def _refuse_twice(studies: Sequence[FoundStudy]) -> None:
    seen: set[Path] = set()
    for study in studies:
        folder = real_path(study.folder)
        if folder in seen:
            raise PopulationError(
                f"study {study.folder} is given twice: each cell counts once; leave one out"
            )
        seen.add(folder)
