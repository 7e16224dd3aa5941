"""`cytodisk export` as a function."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable, Collection, Iterator, Sequence
from contextlib import contextmanager, suppress
from itertools import count, groupby
from pathlib import Path
from typing import Any

from cytodisk.checks import is_path
from cytodisk.errors import ParameterError, StudyError
from cytodisk.files import make_folder, real_path, temporary_name, writing_to
from cytodisk.images.formats.outlined.roi_bytes import require_roifile
from cytodisk.images.image_paths import is_zarr
from cytodisk.runs.run_options import ExportOptions, Progress, silent
from cytodisk.store.spatial.geojson_sets import write_geojson_set
from cytodisk.store.spatial.place_parameters import SpatialParameters
from cytodisk.store.spatial.roi_sets import NUCLEI, OUTLINES, WINDOWS, write_roi_sets
from cytodisk.store.spatial.spatialdata_object import require_spatialdata
from cytodisk.store.spatial.study_places import StudyImage, images_of
from cytodisk.store.study import Study, open_study
from cytodisk.taking import takes

FORMATS = ("roi", "geojson", "spatialdata")
SPATIALDATA = "spatialdata.zarr"
_SHOWN = 3


@takes(SpatialParameters, ExportOptions)
def run_export(
    study: str | os.PathLike[str],
    out: str | os.PathLike[str],
    to: str | Sequence[str],
    *,
    progress: Progress | None = None,
    **settings: Any,
) -> list[Path]:
    """Write the cells and windows of a study for Fiji, QuPath or SpatialData: `cytodisk export`.

    Parameters
    ----------
    study : path-like
        Folder that `cytodisk map` or `cytodisk movie` wrote.
    out : path-like
        Folder for the files; it is made if need be.
    to : {"roi", "geojson", "spatialdata"} or sequence of these
        "roi" are sets for ImageJ's ROI Manager: outlines.zip, windows.zip, and nuclei.zip where there are
        nuclei. "geojson" is cells.geojson for QuPath, "spatialdata" spatialdata.zarr. Where the masks came
        from many files, each has its own, with its name in front; spatialdata.zarr holds all.
    progress : callable, optional
        Called with (images done, images in all).
    **settings
        See `SpatialParameters` and `ExportOptions`.

    Returns
    -------
    list of Path
        What was written.

    Raises
    ------
    ParameterError
        A parameter is unknown or out of its range.
    ReadError
        The study, a map of it or an image is not there.
    StudyError
        A file of such a name is there.
    MissingPartError
        roifile or spatialdata is not installed.

    See Also
    --------
    Study.to_spatialdata : The same as an object in memory.

    Examples
    --------
    >>> import tifffile
    >>> import cytodisk as cd
    >>> tifffile.imwrite("mask.tif", cd.simulate.disk(12).astype("uint8"))
    >>> _ = cd.run_map("mask.tif", "out", layers=3, sectors=8)
    >>> [path.name for path in cd.run_export("out", "fiji", to="geojson")]
    ['cells.geojson']
    """
    is_path("study", study)
    is_path("out", out)
    kinds = checked_formats([to] if isinstance(to, str) else to)
    options, values = ExportOptions.split(settings, SpatialParameters)
    parameters = SpatialParameters.of(**values)
    for kind, require in {"roi": require_roifile, "spatialdata": require_spatialdata}.items():
        if kind in kinds:
            require()
    opened, folder = open_study(study), Path(out)
    by_source = [list(group) for _, group in groupby(images_of(opened, parameters), lambda one: one.source)]
    _refuse_files(folder, _names(kinds, by_source), options.overwrite, _inputs_of(opened))
    done = _counted(len(kinds) * sum(map(len, by_source)), progress or silent)
    with _folder(folder):
        return _write(opened, folder, kinds, by_source, parameters, done)


def _write(
    opened: Study,
    folder: Path,
    kinds: Sequence[str],
    by_source: Sequence[Sequence[StudyImage]],
    parameters: SpatialParameters,
    done: Callable[[], None],
) -> list[Path]:
    written: list[Path] = []
    if "spatialdata" in kinds:  # first, as it reads the images, which may be gone
        written.append(_write_spatialdata(opened, folder / SPATIALDATA, parameters))
        for _ in range(sum(map(len, by_source))):
            done()
    for images in by_source:
        prefix = _prefix(images, by_source)
        if "roi" in kinds:
            written += write_roi_sets(opened, images, folder, prefix, parameters.windows, done)
        if "geojson" in kinds:
            written.append(folder / f"{prefix}cells.geojson")
            write_geojson_set(opened, images, written[-1], parameters.windows, done)
    return written


@contextmanager
def _folder(path: Path) -> Iterator[None]:
    """A folder to write into; one that was made for nothing goes again."""
    is_new = not path.exists()
    with writing_to(path):
        make_folder(path)
    try:
        yield
    finally:
        if is_new:
            with suppress(OSError):  # it holds files
                path.rmdir()


def checked_formats(given: Sequence[str]) -> tuple[str, ...]:
    """The formats that are wanted, each once.

    Raises
    ------
    ParameterError
        There are none, or one is unknown.
    """
    unknown = [word for word in given if word not in FORMATS]
    if unknown or not given:
        got = repr(unknown[0]) if unknown else "none"
        raise ParameterError(f"to (--to) must name some of {', '.join(FORMATS)}, got {got}")
    return tuple(dict.fromkeys(given))


def _prefix(images: Sequence[StudyImage], by_source: Sequence[Sequence[StudyImage]]) -> str:
    """What stands before the names of the files of one file of masks."""
    if len(by_source) == 1:
        return ""
    name = images[0].name
    return f"{name.rpartition('_frame_')[0] if images[0].is_stack else name}_"


def _names(kinds: Sequence[str], by_source: Sequence[Sequence[StudyImage]]) -> list[str]:
    """Names of the files that may be written."""
    names = [SPATIALDATA] if "spatialdata" in kinds else []
    for images in by_source:
        own = [f"{kind}.zip" for kind in (OUTLINES, NUCLEI, WINDOWS)] if "roi" in kinds else []
        own += ["cells.geojson"] if "geojson" in kinds else []
        names += [_prefix(images, by_source) + name for name in own]
    return names


def _inputs_of(study: Study) -> set[Path]:
    """The files that the study was made from, as far as they are found from here."""
    found = set()
    for told in study.provenance.get("inputs", {}).values():
        files = [Path(told["path"]) / name for name in told.get("files", ())]
        found |= {real_path(file) for file in files or [Path(told["path"])]}
    return found


def _refuse_files(folder: Path, names: Sequence[str], overwrite: bool, inputs: Collection[Path]) -> None:
    there = [name for name in names if os.path.lexists(folder / name)]
    if there and not overwrite:
        more = f" and {len(there) - _SHOWN} more" if len(there) > _SHOWN else ""
        raise StudyError(
            f"{folder} holds {', '.join(there[:_SHOWN])}{more} already: name another folder, or pass "
            "--overwrite to replace them"
        )
    if kept := [name for name in there if real_path(folder / name) in inputs]:
        raise StudyError(f"{folder / kept[0]} is an input of the study: name another folder")
    if SPATIALDATA in there and not is_zarr(folder / SPATIALDATA):
        raise StudyError(f"{folder / SPATIALDATA} is no Zarr folder: move it, or name another folder")


def _counted(total: int, progress: Progress) -> Callable[[], None]:
    numbers = count()

    def done() -> None:
        progress(next(numbers), total)

    done()
    return done


def _write_spatialdata(study: Study, path: Path, parameters: SpatialParameters) -> Path:
    """Write it whole or not at all."""
    data = study.to_spatialdata(**dict(parameters))
    temporary = path.with_name(temporary_name(".zarr"))
    try:
        with writing_to(path):
            data.write(temporary)
            if path.exists():
                shutil.rmtree(path)
            temporary.rename(path)
    finally:
        shutil.rmtree(temporary, ignore_errors=True)
    return path
