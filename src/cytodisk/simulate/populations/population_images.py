"""A population as files: label images, signals, nuclei and the table of groups, with the answers."""

import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import pandas as pd
import tifffile

from cytodisk.arrays import FloatArray
from cytodisk.checks import is_path, whole_number
from cytodisk.files import make_folder
from cytodisk.simulate.label_images import packed
from cytodisk.simulate.populations.drawn_cells import DrawnCell, drawn_cell
from cytodisk.simulate.populations.population_image_parameters import PopulationImageParameters
from cytodisk.simulate.populations.simulated_cells import cell_rows
from cytodisk.taking import takes

_GROUP_COLUMNS = ["file", "condition", "experiment"]
_MARGIN = 6  # px of background around the cells of an image
_BACKGROUND, _BRIGHTNESS = 20.0, 200.0  # counts of a pixel
_ImageStack: TypeAlias = np.ndarray[Any, np.dtype[np.uint16]]


@dataclass(frozen=True, eq=False)
class PopulationImages:
    """Files of a population, and what is known of its cells.

    Attributes
    ----------
    masks : Path
        Folder of label images, NAME_cp_masks.tif.
    images : Path
        Folder of signals, NAME.ome.tif, which name their channels and the pixel size.
    nuclei : Path or None
        Folder of label images of nuclei, NAME.tif.
    groups : Path
        Table with the columns `file`, which is NAME, `condition` and `experiment`.
    cells : DataFrame
        A row a cell. Columns: `file`; `label`; `condition`; `experiment`; `arms`, whether it has any;
        `brightness`, by which all of its signal is multiplied; `region_direction`, from the cell's centroid
        in degrees from +x towards +y; `region_share`, the share of the cell's pixels that lie in the region.

    Examples
    --------
    >>> import cytodisk as cd
    >>> files = cd.simulate.population_images("made", experiments=1, cells=2)
    >>> files.groups.read_text().splitlines()
    ['file,condition,experiment', 'control_1,control,experiment 1', 'drug_1,drug,experiment 2']
    """

    masks: Path
    images: Path
    nuclei: Path | None
    groups: Path
    cells: pd.DataFrame


@takes(PopulationImageParameters)
def population_images(folder: str | os.PathLike[str], seed: int = 0, **settings: Any) -> PopulationImages:
    """Write label images and signals of a population, a region of the cells brighter in some conditions.

    The region lies at the edge of a cell, down to a third of its largest depth, within 60 degrees of one
    direction: to the right, or with nuclei away from the nucleus.

    Parameters
    ----------
    folder : path
        Made if it is not there; files in it of the same names are written over.
    seed : int
        The same arguments give the same files.
    **settings
        See `PopulationImageParameters`.

    Returns
    -------
    PopulationImages

    Raises
    ------
    ParameterError
        A number is out of its range, or numbers do not fit each other.

    See Also
    --------
    population : Windows of a population, without images.
    label_image : One image of many cells.

    Examples
    --------
    >>> import cytodisk as cd
    >>> files = cd.simulate.population_images("made", experiments=2, cells=3)
    >>> sorted(path.name for path in files.masks.iterdir())[:2]
    ['control_1_cp_masks.tif', 'control_2_cp_masks.tif']
    >>> cd.read_image(files.images / "drug_1.ome.tif").dims
    ('channel', 'y', 'x')
    """
    is_path("folder", folder)
    how = PopulationImageParameters.of(**settings)
    random = np.random.default_rng([29, whole_number("seed", seed, 0)])
    rows = cell_rows(how, random)
    of_experiment = random.normal(size=int(rows[1].max()) + 1)
    folders = {name: Path(folder) / name for name in ("masks", "images", *["nuclei"] * how.nuclei)}
    for made in folders.values():
        make_folder(made)
    tables = []
    for condition, experiment in np.unique(np.column_stack(rows), axis=0).tolist():
        own = (rows[0] == condition) & (rows[1] == experiment)
        name = f"{how.conditions[condition]}_{experiment - rows[1][rows[0] == condition].min() + 1}"
        shared = np.sqrt(how.between_experiments) * of_experiment[experiment]
        varied = shared + np.sqrt(1.0 - how.between_experiments) * random.normal(size=int(own.sum()))
        effect, brightness = how.effect_of[condition], np.exp(how.deviation * varied)
        cells = [drawn_cell(how, effect, bright, random) for bright in brightness.tolist()]
        _write(folders, name, cells, how, random)
        groups = [name, how.conditions[condition], f"experiment {experiment + 1}"]
        columns = dict(zip(_GROUP_COLUMNS, groups, strict=True))
        tables.append(pd.DataFrame([columns | row for row in _rows(cells)]))
    table = pd.concat(tables, ignore_index=True)
    groups_file = Path(folder) / "groups.csv"
    table[_GROUP_COLUMNS].drop_duplicates().to_csv(groups_file, index=False)
    return PopulationImages(folders["masks"], folders["images"], folders.get("nuclei"), groups_file, table)


def _rows(cells: list[DrawnCell]) -> Iterator[dict[str, Any]]:
    for label, cell in enumerate(cells, start=1):
        yield {
            "label": label,
            "arms": cell.arms,
            "brightness": cell.brightness,
            "region_direction": cell.direction_deg,
            "region_share": float(cell.region[cell.mask].mean()),
        }


def _write(
    folders: dict[str, Path],
    name: str,
    cells: list[DrawnCell],
    how: PopulationImageParameters,
    random: np.random.Generator,
) -> None:
    """The files of one image."""
    corners, (height, width) = packed([cell.mask for cell in cells])
    labels, nuclei = np.zeros((2, height + 2 * _MARGIN, width + 2 * _MARGIN), dtype=np.uint16)
    counts: FloatArray = np.full((len(how.channels), *labels.shape), _BACKGROUND)
    for label, (cell, (y, x)) in enumerate(zip(cells, corners, strict=True), start=1):
        top, left = y + _MARGIN, x + _MARGIN
        part = np.s_[top : top + cell.mask.shape[0], left : left + cell.mask.shape[1]]
        labels[part][cell.mask] = label
        nuclei[part][cell.nucleus] = label
        counts[:, *part] += _BRIGHTNESS * cell.signals
    tifffile.imwrite(folders["masks"] / f"{name}_cp_masks.tif", labels)
    if how.nuclei:
        tifffile.imwrite(folders["nuclei"] / f"{name}.tif", nuclei)
    signal: _ImageStack = random.poisson(counts).clip(0, 65_535).astype(np.uint16)
    metadata = {
        "axes": "CYX",
        "Channel": {"Name": list(how.channels)},
        "PhysicalSizeX": how.pixel_size_um,
        "PhysicalSizeXUnit": "µm",
        "PhysicalSizeY": how.pixel_size_um,
        "PhysicalSizeYUnit": "µm",
    }
    tifffile.imwrite(folders["images"] / f"{name}.ome.tif", signal, metadata=metadata, ome=True)
