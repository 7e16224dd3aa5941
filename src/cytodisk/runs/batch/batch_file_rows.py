"""A row of a batch file → its inputs: a pattern of mask files, and templates that follow each of them."""

from __future__ import annotations

import glob
import os
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from string import Formatter
from typing import Any

from cytodisk.errors import ParameterError
from cytodisk.files import real_path
from cytodisk.images.image_paths import is_folder_of_files, is_pattern
from cytodisk.images.mask_names import base_name, image_stem, natural_order
from cytodisk.runs.batch.batch_input import BatchInput, InputKind, Value
from cytodisk.runs.cells.nuclei_given import ONLY_WITH_NUCLEI
from cytodisk.runs.given_tables.table_faults import Faults
from cytodisk.runs.given_tables.taken_names import RENAMED, renamed_words
from cytodisk.runs.map.map_parameters import MapParameters, WindowsOfMapsParameters
from cytodisk.runs.movie.movie_parameters import MovieParameters
from cytodisk.runs.parameters_file import parameters_from

SCALE = ("pixel_size_um", "frame_interval_s", "channels")  # parameters with a column of their own
ALONE = (*SCALE, "tracks")  # parameters with a key of their own
COLUMNS = ("condition", "experiment")  # texts, also where they look like numbers
KEYS = ("masks", "signal", "nuclei", "name", "kind", "parameters", *COLUMNS, *ALONE)
PARAMETERS_OF: dict[str, type[WindowsOfMapsParameters]] = {"movie": MovieParameters, "map": MapParameters}
FIELDS = ("folder", "parent", "name", "stem", "image")  # of templates
_LONGEST_NAME = 120  # bytes in UTF-8; folders and files may have 255, of which some go for temporary names
_BESIDE = ("_", "-", ".")  # how the ending of an image's name begins, for a folder of masks


@dataclass(frozen=True)
class FileRow:
    """A row as it stands in the file.

    Attributes
    ----------
    place : str
        Where it stands, in words.
    values : dict
        By key; none of them is None.
    """

    place: str
    values: dict[str, Any]


@dataclass(frozen=True)
class RowReader:
    """What all rows of a file have in common.

    Attributes
    ----------
    folder : Path
        Folder of the batch file; paths are relative to it.
    kind : {"movie", "map"}
        Of inputs that say none.
    parameters : dict
        Parameters of the file.
    columns : tuple of str
        Names of the columns that the user gives.
    faults : Faults
    """

    folder: Path
    kind: InputKind
    parameters: dict[str, Any]
    columns: tuple[str, ...]
    faults: Faults

    def inputs(self, row: FileRow) -> Iterator[BatchInput]:
        """The inputs of a row, in natural order of their names; faults are noted."""
        for name in (name for name in row.values if name in RENAMED):
            self.faults.add(row.place, renamed_words(name))
        if "groups" in row.values:
            self.faults.add(row.place, "groups stands in [study]: one table for all inputs")
        names = [name for name in row.values if name not in (*RENAMED, "groups")]
        self.faults.add_unknown(row.place, "column", names, [*KEYS, *self.columns])
        kind = row.values.get("kind", self.kind)
        if kind not in tuple(PARAMETERS_OF):
            self.faults.add(row.place, f"kind must be movie or map, got {kind!r}")
            return
        parameters = self._parameters(row, kind)
        pattern = row.values.get("masks")
        if not isinstance(pattern, str) or not pattern:
            self.faults.add(
                row.place, f"masks must be a path or a pattern as 'control/*.tif', got {pattern!r}"
            )
            return
        found = self._matches(pattern, kind)
        if not found:
            self.faults.add(row.place, f"masks {pattern!r} match nothing in {self.folder}")
        if not self._check_templates(row):
            return
        for masks in found:
            item = self._input(row, kind, masks, parameters)
            if item is not None:
                yield item

    def _parameters(self, row: FileRow, kind: str) -> WindowsOfMapsParameters | None:
        """The file's parameters, but for those that mean nothing here, overruled by the row's own."""
        of = PARAMETERS_OF[kind]
        own = row.values.get("parameters", {})
        if not isinstance(own, dict):
            self.faults.add(row.place, f"parameters must be a table as {{layers = 5}}, got {own!r}")
            return None
        if set(own) - set(of.model_fields):
            self.faults.add_unknown(row.place, "parameter", own, of.model_fields)
            return None
        own = own | {name: row.values[name] for name in ALONE if name in row.values}
        for name in ("frame_interval_s", "tracks"):
            if kind == "map" and name in own:
                self.faults.add(row.place, f"{name} is for movies only: take it out")
                return None
        shared = {name: value for name, value in self.parameters.items() if name in of.model_fields}
        if "nuclei" not in row.values:
            shared = {name: value for name, value in shared.items() if name not in ONLY_WITH_NUCLEI}
        for one, other in of.exclusive:
            for given, left_out in ((one, other), (other, one)):
                if given in own:
                    shared.pop(left_out, None)
            if one in shared and other in shared:
                shared.pop(one)  # a study's parameters.toml has both, of which the second counts
        try:
            return parameters_from(shared | own, None, of)
        except ParameterError as error:
            self.faults.add(row.place, str(error))
            return None

    def _matches(self, pattern: str, kind: str) -> list[Path]:
        literal = self.folder / pattern
        if _exists(literal):
            found = [literal]
        else:
            names = glob.glob(pattern, root_dir=self.folder, recursive=True)  # noqa: PTH207  may be absolute
            found = [self.folder / name for name in sorted(names, key=natural_order)]
        files = [path for path in found if not is_folder_of_files(path)]
        return found if kind == "map" else files or found  # folders of movies are those of one file a frame

    def _input(
        self, row: FileRow, kind: InputKind, masks: Path, parameters: WindowsOfMapsParameters | None
    ) -> BatchInput | None:
        if not _is_text(masks):
            self.faults.add(row.place, f"the name of {str(masks)!a} is not in UTF-8: rename the file")
            return None
        fields = path_fields(masks, self.folder)
        place = f"{row.place}, {masks.name}"
        filled = {key: _fill(value, fields) for key, value in row.values.items() if key != "masks"}
        signal, nuclei = (self._beside(place, masks, role, filled.get(role)) for role in ("signal", "nuclei"))
        safe = {name: re.sub(r"[^\w.-]+", "-", text).strip("-.") for name, text in fields.items()}
        name = str(_fill(row.values.get("name", "{folder}-{stem}"), safe)).strip("-")
        if re.fullmatch(r"\w[\w.-]*(?<!\.)", name) is None or len(name.encode()) > _LONGEST_NAME:
            self.faults.add(
                place,
                f"name {name!r} cannot be that of a folder: use letters, digits, '_', '-' and '.' (at most "
                f"{_LONGEST_NAME} bytes)",
            )
            return None
        columns = tuple(self._value(place, column, filled.get(column)) for column in self.columns)
        if parameters is None:
            return None
        if "tracks" in filled:
            tracks = self.folder / str(filled["tracks"])
            if not _exists(tracks):
                self.faults.add(place, f"tracks {tracks} do not exist")
            parameters = parameters.changed(tracks=str(tracks))
        return BatchInput(name, kind, masks, signal, parameters, columns, nuclei=nuclei)

    def _check_templates(self, row: FileRow) -> bool:
        right = True
        for key, value in row.values.items():
            if key == "masks" or not isinstance(value, str):
                continue
            try:
                fields = [(name, form or how) for _, name, form, how in Formatter().parse(value)]
            except ValueError as error:
                self.faults.add(row.place, f"{key} {value!r} is no template: {error}; write {{{{ for a brace")
                right = False
                continue
            wanted = [f"{name}:{form}" if form else name for name, form in fields if name is not None]
            self.faults.add_unknown(row.place, f"field in {key}", wanted, FIELDS)
            right = right and set(wanted) <= set(FIELDS)
        return right

    def _beside(self, place: str, masks: Path, role: str, value: Any) -> Path | None:
        """The path of a signal, or of nuclei, that go with masks."""
        if value is None:
            return None
        if not isinstance(value, str):
            self.faults.add(place, f"{role} must be a path, got {value!r}")
            return None
        path = self.folder / value
        if is_folder_of_files(masks) and value.startswith(_BESIDE) and not _exists(path):
            return Path(value)  # how the names of files go on beside the masks
        if not _exists(path) and not (is_pattern(path) and glob.glob(str(path), recursive=True)):  # noqa: PTH207
            self.faults.add(place, f"{role} {path} does not exist")
        elif not is_folder_of_files(masks) and real_path(path) == real_path(masks):
            advice = "name its image" if role == "signal" else "name the masks of its nuclei"
            self.faults.add(place, f"{role} {path} is the mask file itself: {advice}, or take {role} out")
        return path

    def _value(self, place: str, column: str, value: Any) -> Value:
        if value is None or isinstance(value, str | int | float):
            return value if value is None or column not in COLUMNS else str(value)
        self.faults.add(place, f"{column} must be a text or a number, got {value!r}")
        return None


def _exists(path: Path) -> bool:
    return os.path.exists(path)  # noqa: PTH110  where Path would raise for a name that is too long


def _is_text(path: Path) -> bool:
    """Whether tables and messages can hold it; names of files can have any bytes."""
    return re.search("[\ud800-\udfff]", str(path)) is None


def _fill(value: Any, fields: Mapping[str, str]) -> Any:
    """A template's text for one mask file; what is no text stays as it is."""
    return value.format_map(fields) if isinstance(value, str) else value


def path_fields(masks: Path, folder: Path) -> dict[str, str]:
    """What templates can take from the path of a mask file.

    Parameters
    ----------
    masks, folder : Path
        The file, and the folder of the batch file.

    Returns
    -------
    dict of str to str
        "folder" (its path from the folder of the batch file, or else in full), "parent" (the last part of
        it), "name" (of the file), "stem" (without .tif or .ome.tif), "image" (without _masks.tif and the like
        too).
    """
    parent = masks.parent.relative_to(folder) if masks.parent.is_relative_to(folder) else masks.parent
    return {
        "folder": parent.as_posix(),
        "parent": masks.parent.name,
        "name": masks.name,
        "stem": image_stem(masks.name),
        "image": base_name(masks.name),
    }
