"""The images that a study measured, frame by frame, if they still hold what was measured."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from cytodisk.arrays import AnyArray
from cytodisk.errors import CytodiskError, ReadError
from cytodisk.files import file_name
from cytodisk.images.file_parameters import SignalFileParameters
from cytodisk.images.frame_file import FileChoice, FrameFile
from cytodisk.images.frames import open_frames
from cytodisk.images.image_paths import is_folder_of_files, sha256_of
from cytodisk.images.mask_files import MaskSource
from cytodisk.images.signal_files import FrameSource, pair_images
from cytodisk.store.inputs.study_signal import MeasuredStudy, find_signal

_REMEDY = "put it back, or start in the folder where the study was made, or pass images=False (--no-images)"


@dataclass(frozen=True)
class StudyImages:
    """Images of a study, read when asked for.

    Attributes
    ----------
    study : Study
        Of `cytodisk map` or `cytodisk movie`.
    """

    study: MeasuredStudy

    @property
    def is_measured(self) -> bool:
        """Whether the study has a signal."""
        return bool(self._told)

    def frame(self, source: str, frame: int) -> AnyArray:
        """The pixels of a frame.

        Parameters
        ----------
        source : str
            Name of the mask file in the study; a movie has one.
        frame : int

        Returns
        -------
        ndarray of shape (C, H, W)

        Raises
        ------
        ReadError
            The image is not there any more, or holds something else than what was measured.
        """
        if self.study.provenance["run"] == "movie":
            file = self._movie
        elif source not in self._opened:
            file = self._opened[source] = self._image_of(source)
        else:
            file = self._opened[source]
        return file.frame(min(frame, file.n_frames - 1))

    @property
    def _told(self) -> dict[str, Any]:
        told: dict[str, Any] = self.study.provenance.get("inputs", {}).get("signal") or {}
        return told

    @cached_property
    def _opened(self) -> dict[str, FrameFile]:
        return {}

    @cached_property
    def _movie(self) -> FrameSource:
        found = find_signal(self.study)
        if found.source is None:
            raise ReadError(f"the signal of study {self.study.path} cannot be read: {found.fault}; {_REMEDY}")
        return found.source

    @cached_property
    def _choice(self) -> FileChoice:
        settings = self.study.provenance["parameters"]
        known = {name: settings[name] for name in SignalFileParameters.model_fields if name in settings}
        return SignalFileParameters.of(**known).signal_choice

    def _image_of(self, source: str) -> FrameFile:
        try:
            path = self._path_of(source)
            if sha256_of(path) != self._hash_of(path):
                raise ReadError(f"{path.name} does not hold what was measured (its sha256 differs)")
            rows = self.study.cells[self.study.cells["source"] == source]
            return open_frames(path, unnamed="T" if rows["frame"].max() > 0 else "C", choice=self._choice)
        except (CytodiskError, OSError) as error:
            raise ReadError(
                f"the image of {source} in study {self.study.path} cannot be read: {error}; {_REMEDY}"
            ) from error

    def _path_of(self, source: str) -> Path:
        """Where the image of a mask file lies now."""
        if "files" not in self._told:
            return _found(self._places(self._told["path"]))
        folder = _found(self._places(self.study.provenance["inputs"]["masks"]["path"]))
        masks = [MaskSource(source, folder / source, None, None)]
        given = str(self._told.get("given") or self._told["path"])
        there = [place for place in self._places(given) if is_folder_of_files(place)]
        (image,) = pair_images(masks, there[0] if there else given)
        if isinstance(image, CytodiskError):
            raise image
        return image

    def _hash_of(self, path: Path) -> str:
        """What the image held when it was measured."""
        marks: dict[str, str] = self._told.get("files", {})
        by_name = {Path(name).name: mark for name, mark in marks.items()}
        return by_name.get(path.name, str(self._told["sha256"]))

    def _places(self, given: str) -> Sequence[Path]:
        """A path, from the current folder, the study's and the one around it."""
        path = Path(given)
        return [path] if path.is_absolute() else [path, self.study.path.parent / path, self.study.path / path]


def _found(places: Sequence[Path]) -> Path:
    there = [place for place in places if place.exists()]
    if not there:
        raise ReadError(f"{file_name(str(places[0]))} is not there any more")
    return there[0]
