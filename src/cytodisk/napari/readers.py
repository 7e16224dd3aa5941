"""Readers of the plugin: studies, single maps, activity stores and nothing else."""

from __future__ import annotations

import zipfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from cytodisk.disk.loading import load_map
from cytodisk.errors import ReadError
from cytodisk.napari.study_layers.activity_layers import activity_layers
from cytodisk.napari.study_layers.layers_of_study import LayerData
from cytodisk.napari.study_layers.map_layers import map_layers
from cytodisk.napari.study_layers.shown_study import attach, layers_of, say_missing
from cytodisk.napari.study_layers.study_in_viewer import ShownStudy
from cytodisk.napari.viewer_parts import current_viewer
from cytodisk.store.provenance_file import PROVENANCE, read_provenance
from cytodisk.store.study import open_study
from cytodisk.store.study_kind import ACTIVITY, MAPS

Reader = Callable[[Any], list[LayerData]]

_MAP_ARRAYS = {"header.npy", "vertices_uv.npy", "triangles.npy"}


def get_reader(path: str | Sequence[str]) -> Reader | None:
    """The reader of a path, if it is one of cytodisk's.

    Parameters
    ----------
    path : str or sequence of str
        A study's folder or its provenance file, a map, or the activity of a study.

    Returns
    -------
    callable or None
    """
    if not isinstance(path, str | Path):
        return get_reader(path[0]) if len(path) == 1 else None
    given = Path(path)
    if given.name == PROVENANCE:
        given = given.parent
    if given.name in (ACTIVITY, Path(ACTIVITY).stem) and given.exists():
        return lambda _: activity_layers(given)
    if given.is_dir():
        return (lambda _: study_layers(given)) if _is_study(given) else None
    return (lambda _: _layers_of_map(given)) if given.suffix == ".npz" and _is_map(given) else None


def study_layers(folder: Path) -> list[LayerData]:
    """Layers of a study; once they are in the viewer, they follow its slider.

    Parameters
    ----------
    folder : Path

    Returns
    -------
    list of (data, settings, kind)
        The activity alone, for a movie without maps.

    Raises
    ------
    ReadError
        The folder is no study that can be shown, or it is damaged.
    """
    shown, viewer = ShownStudy(open_study(folder)), current_viewer()
    layers = layers_of(shown, () if viewer is None else viewer.layers)
    if not layers:
        raise ReadError(shown.cells.missing_words)
    if viewer is not None:
        attach(viewer, shown, len(layers))
    say_missing(shown)
    return layers


def _layers_of_map(path: Path) -> list[LayerData]:
    """Layers of one map: with the windows of its study, where it lies in one."""
    folder = path.parent.parent
    if path.parent.name == MAPS and _is_study(folder):
        return map_layers(path.stem, load_map(path), open_study(folder))
    return map_layers(path.stem, load_map(path))


def _is_study(folder: Path) -> bool:
    """Whether a run of cytodisk wrote to a folder, be it complete or not."""
    try:
        return read_provenance(folder) is not None
    except ReadError:
        return True  # it is one, and opening it says what is wrong


def _is_map(path: Path) -> bool:
    try:
        with zipfile.ZipFile(path) as archive:
            return set(archive.namelist()) >= _MAP_ARRAYS
    except (OSError, zipfile.BadZipFile):
        return False
