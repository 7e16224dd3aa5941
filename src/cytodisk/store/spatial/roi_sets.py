"""Outlines of a study's cells, nuclei and windows as sets of ImageJ's ROIs."""

from __future__ import annotations

import zipfile
from collections.abc import Callable, Iterable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

from cytodisk.arrays import FloatArray
from cytodisk.files import replacing
from cytodisk.images.formats.outlined.roi_bytes import encoded_roi
from cytodisk.store.spatial.study_places import MappedStudy, PlacedCell, StudyImage

Colour = tuple[int, int, int]

OUTLINES, NUCLEI, WINDOWS = "outlines", "nuclei", "windows"
_LINES: dict[str, Colour] = {OUTLINES: (255, 255, 0), NUCLEI: (86, 180, 233)}  # yellow; sky blue
_WHITE = 0.4  # share of it in the colours of layers, of which the first are dark
_DIGITS = 4  # of a slice in a name, as ImageJ writes it


def write_roi_sets(
    study: MappedStudy,
    images: Iterable[StudyImage],
    folder: Path,
    prefix: str,
    with_windows: bool,
    done: Callable[[], None],
) -> list[Path]:
    """Write the outlines of the cells, of their nuclei and of their windows, a file for each.

    Parameters
    ----------
    study : Study
    images : iterable of StudyImage
        Of one file of masks.
    folder : Path
    prefix : str
        Stands before the names outlines.zip, nuclei.zip and windows.zip.
    with_windows : bool
    done : callable
        Is called after each image.

    Returns
    -------
    list of Path
        Of the files; one without a ROI is not written.

    Raises
    ------
    MissingPartError
        roifile is not installed.
    WriteError
        The folder cannot be written.
    """
    written: list[Path] = []
    colours = _layer_colours(study)
    with ExitStack() as open_sets:
        sets: dict[str, zipfile.ZipFile] = {}
        for image in images:
            for placed in image.cells(study):
                for kind, name, polygon, colour in _outlines(placed, with_windows, colours):
                    if kind not in sets:
                        written.append(folder / f"{prefix}{kind}.zip")
                        sets[kind] = open_sets.enter_context(_zip_file(written[-1]))
                    frame = image.frame if image.is_stack else None
                    called = roi_name(placed.cell, name, frame)
                    roi = encoded_roi(polygon + placed.corner, called, colour, frame)
                    sets[kind].writestr(f"{called}.roi", roi)
            done()
    return written


def roi_name(cell: int, part: str, frame: int | None) -> str:
    """Name of a ROI.

    Of a single image as "cell 3, layer 0, sector 5". In a stack as "0013-cell-3, layer 0, sector 5" with the
    number of the slice, from 1, in front: ImageJ looks for it there in a stack that is no hyperstack, where
    it does not look at the time of a ROI.
    """
    return f"cell {cell}, {part}" if frame is None else f"{frame + 1:0{_DIGITS}}-cell-{cell}, {part}"


def _outlines(
    placed: PlacedCell, with_windows: bool, colours: list[Colour]
) -> Iterator[tuple[str, str, FloatArray, Colour]]:
    windows = placed.windows
    yield OUTLINES, "outline", windows.outline_yx, _LINES[OUTLINES]
    nucleus = windows.disk.nucleus_outline_yx
    if nucleus is not None:
        yield NUCLEI, "nucleus", nucleus, _LINES[NUCLEI]
    if with_windows:
        for window, polygon in enumerate(windows.polygons()):
            layer, sector = divmod(window, windows.sectors)
            if len(polygon):  # layers by depth that are deeper than the cell have none
                yield WINDOWS, f"layer {layer}, sector {sector}", polygon, colours[layer]


@contextmanager
def _zip_file(path: Path) -> Iterator[zipfile.ZipFile]:
    with replacing(path) as temporary, zipfile.ZipFile(temporary, "w", zipfile.ZIP_DEFLATED) as opened:
        yield opened


def _layer_colours(study: MappedStudy) -> list[Colour]:
    """Of lines over an image, which is dark in most places."""
    from cytodisk.plot.layer_looks import layer_colours
    from cytodisk.windows.study_grid import polar_grid_of

    grid = polar_grid_of(study.provenance)
    found = layer_colours(range(grid.layers), grid.cytoplasm_layers if grid.nucleus_layers else None)
    lighter = (255 * (found + _WHITE * (1 - found))).round()
    return [(int(red), int(green), int(blue)) for red, green, blue, _ in lighter]
