"""A study as `spatialdata.SpatialData`: images, labels, shapes and tables that know each other."""

from __future__ import annotations

from collections.abc import Sequence
from importlib.metadata import version
from typing import TYPE_CHECKING, Any

import numpy as np

from cytodisk.errors import MissingPartError
from cytodisk.population.anndata_table import require_anndata
from cytodisk.population.plain_columns import file_key
from cytodisk.store.inputs.study_images import StudyImages
from cytodisk.store.spatial.place_parameters import SpatialParameters
from cytodisk.store.spatial.spatial_parts import ImageParts, Shapes, check_room, parts_of
from cytodisk.store.spatial.spatial_tables import (
    INSTANCE,
    REGION,
    SpatialTable,
    cell_table,
    element_name,
    window_table,
)
from cytodisk.store.spatial.study_places import MappedStudy, StudyImage, images_of, left_out_words
from cytodisk.windows.study_grid import polar_grid_of

if TYPE_CHECKING:
    from spatialdata import SpatialData as SpatialData

PIXELS, MICROMETRES = "global", "µm"


def require_spatialdata() -> Any:
    """The module.

    Raises
    ------
    MissingPartError
        spatialdata is not installed.
    """
    try:
        import spatialdata
    except ImportError as error:
        missing = isinstance(error, ModuleNotFoundError) and error.name == "spatialdata"
        fault = "is not installed" if missing else f"cannot be imported ({error})"
        raise MissingPartError.of("a SpatialData object needs spatialdata", "spatialdata", fault) from error
    return spatialdata


def spatialdata_of(study: MappedStudy, parameters: SpatialParameters) -> SpatialData:
    """A study, or some of its cells and frames.

    Parameters
    ----------
    study : Study
    parameters : SpatialParameters

    Returns
    -------
    SpatialData

    Raises
    ------
    MissingPartError
        spatialdata is not installed.
    ReadError
        A map or an image is gone, or all of it does not fit into memory.
    """
    spatialdata = require_spatialdata()
    images, n_windows = images_of(study, parameters), polar_grid_of(study.provenance).n_windows
    check_room(study, images, parameters, n_windows)
    signal = StudyImages(study)
    pixels = signal if parameters.images and signal.is_measured else None
    elements: dict[str, Any] = {}
    per_cell = cell_table(study, images)
    for image in images:
        parts = parts_of(study, image, pixels, parameters.windows, n_windows)
        elements |= _elements(image, parts, list(per_cell.var.index), study)
    elements["cell_table"] = _table(per_cell, study, images, "cells")
    if parameters.windows:
        per_window = window_table(study, images, n_windows)
        elements["window_table"] = _table(per_window, study, images, "windows")
    made: SpatialData = spatialdata.SpatialData.init_from_elements(elements)
    made.attrs["cytodisk"] = {
        "version": version("cytodisk"),
        "run": str(study.provenance["run"]),
        "pixel_size_um": study.scale.pixel_size_um,
        "frame_interval_s": study.scale.frame_interval_s,
        "left_out": left_out_words(study, parameters),
    }
    return made


def _elements(
    image: StudyImage, parts: ImageParts, channels: list[str], study: MappedStudy
) -> dict[str, Any]:
    from spatialdata.models import Image2DModel, Labels2DModel, ShapesModel

    places = _transformations(image, study)
    found: dict[str, Any] = {}
    if parts.image is not None:
        given = parts.image.astype(np.uint8) if parts.image.dtype == bool else parts.image
        found["image"] = Image2DModel.parse(
            given, dims=("c", "y", "x"), c_coords=channels, transformations=places
        )
    labels = {"cell_labels": parts.cell_labels}
    if parts.windows.numbers:
        labels["window_labels"] = parts.window_labels
    for name, pixels in labels.items():
        found[name] = Labels2DModel.parse(pixels, dims=("y", "x"), transformations=places)
    for name, shapes in {"cells": parts.cells, "windows": parts.windows, "nuclei": parts.nuclei}.items():
        if shapes.numbers:
            found[name] = ShapesModel.parse(_frame(shapes), transformations=places)
    return {element_name(name, image.name): element for name, element in found.items()}


def _transformations(image: StudyImage, study: MappedStudy) -> dict[str, Any]:
    """From pixels to the coordinate systems of an image: pixels, and µm where the scale is known."""
    from spatialdata.transformations import Identity, Scale

    found: dict[str, Any] = {image.name or PIXELS: Identity()}
    size = study.scale.pixel_size_um
    if size is not None:
        found[element_name(image.name, MICROMETRES) if image.name else MICROMETRES] = Scale(
            [size, size], axes=("x", "y")
        )
    return found


def _frame(shapes: Shapes) -> Any:
    from geopandas import GeoDataFrame

    return GeoDataFrame(shapes.columns, geometry=shapes.polygons, index=shapes.numbers)


def _table(table: SpatialTable, study: MappedStudy, images: Sequence[StudyImage], element: str) -> Any:
    from spatialdata.models import TableModel

    units = getattr(study, element).attrs.get("units", {})
    notes = {file_key(str(name)): str(unit) for name, unit in units.items() if name in table.obs}
    made = require_anndata()(
        X=table.values,
        obs=table.obs,
        var=table.var,
        layers=table.layers,
        obsm={"spatial": table.places},
        uns={"cytodisk": {"values": "mean of the signal", "units": notes}},
    )
    regions = [element_name(element, image.name) for image in images]
    return TableModel.parse(made, region=regions, region_key=REGION, instance_key=INSTANCE)
