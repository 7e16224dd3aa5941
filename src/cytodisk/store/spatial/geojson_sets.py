"""Outlines of a study's cells, nuclei and windows as GeoJSON, with the means of its channels."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any

import shapely

from cytodisk.arrays import FloatArray
from cytodisk.files import replacing
from cytodisk.store.spatial.study_places import MappedStudy, PlacedCell, StudyImage
from cytodisk.store.spatial.study_values import window_means
from cytodisk.windows.window_features import area_within, window_features


def write_geojson_set(
    study: MappedStudy,
    images: Iterable[StudyImage],
    path: Path,
    with_windows: bool,
    done: Callable[[], None],
) -> None:
    """Write the cells as annotations and the windows as detections, as QuPath reads them.

    Parameters
    ----------
    study : Study
    images : iterable of StudyImage
        Of one file of masks.
    path : Path
    with_windows : bool
    done : callable
        Is called after each image.

    Raises
    ------
    WriteError
        The folder cannot be written.
    """
    means = window_means(study)
    with replacing(path) as temporary, temporary.open("w", encoding="utf-8") as file:
        file.write('{"type": "FeatureCollection", "features": [')
        between = "\n"
        for image in images:
            for placed in image.cells(study):
                values = {f"mean {name} a.u.": mean for name, mean in means(placed.cell, image.frame).items()}
                for feature in _features(placed, values, with_windows):
                    if image.is_stack:
                        feature["geometry"] |= {"plane": {"c": -1, "z": 0, "t": image.frame}}
                    file.write(between + json.dumps(feature, ensure_ascii=False))
                    between = ",\n"
            done()
        file.write("\n]}\n")


def _features(
    placed: PlacedCell, values: dict[str, FloatArray], with_windows: bool
) -> Iterator[dict[str, Any]]:
    windows, name = placed.windows, f"cell {placed.cell}"
    layers = windows.layers  # a cell without nucleus has fewer than the table
    own = {channel: mean[:layers] for channel, mean in values.items()}
    polygons = windows.polygons() if with_windows else []
    of_cell, *of_windows = window_features(windows, polygons, own, name, placed.corner)
    yield of_cell
    nucleus = windows.disk.nucleus_outline_yx
    if nucleus is not None:
        area = area_within(nucleus, placed.corner)
        about = {"objectType": "annotation", "name": f"{name}, nucleus"}
        yield {"type": "Feature", "geometry": shapely.geometry.mapping(area), "properties": about}
    for feature in of_windows:
        known = feature["properties"]
        yield {**feature, "properties": {**known, "name": f"{name}, {known['name']}", "cell": placed.cell}}
