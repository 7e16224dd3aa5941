"""A tracks layer written as a session of TrackMate, which `--tracks` and Fiji read."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np

from cytodisk.errors import ReadError
from cytodisk.napari.given.places_in_pixels import in_pixels


def write_tracks(path: Path, layer: Any, image: Any | None) -> None:
    """Write the tracks of a layer with their divisions.

    Parameters
    ----------
    path : Path
    layer : napari.layers.Tracks
        Of (track, t, y, x).
    image : napari.layers.Layer or None
        The layer in whose pixels places are written.

    Raises
    ------
    ReadError
        Tracks have a third dimension, or there are none.
    """
    data = np.asarray(layer.data, dtype=float)
    if data.shape[1] == 5 and np.ptp(data[:, 2]) == 0:
        data = np.delete(data, 2, axis=1)
    if data.shape[1] != 4:
        raise ReadError(f"tracks: layer {layer.name} has tracks in three dimensions: take those of one slice")
    if not len(data):
        raise ReadError(f"tracks: layer {layer.name} holds no track: choose another, or leave tracks out")
    data = data[np.lexsort([data[:, 1], data[:, 0]])]
    names = data[:, 0].astype(int)
    places = in_pixels(layer, data[:, 1:], image)
    root = ElementTree.Element("TrackMate", version="7.0.0")
    model = ElementTree.SubElement(root, "Model", spatialunits="pixel", timeunits="frame")
    _spots(model, np.rint(data[:, 1]).astype(int), places[:, -2:])
    _links(model, names, {int(k): [int(one) for one in of] for k, of in layer.graph.items()})
    ElementTree.ElementTree(root).write(path, encoding="utf-8", xml_declaration=True)


def _spots(model: ElementTree.Element, frames: Any, places: Any) -> None:
    every = ElementTree.SubElement(model, "AllSpots", nspots=str(len(frames)))
    for frame in np.unique(frames).tolist():
        there = ElementTree.SubElement(every, "SpotsInFrame", frame=str(frame))
        for spot in np.flatnonzero(frames == frame).tolist():
            y, x = (f"{value:.4f}" for value in places[spot])
            said = {"FRAME": str(frame), "POSITION_X": x, "POSITION_Y": y, "POSITION_Z": "0.0"}
            ElementTree.SubElement(there, "Spot", said | {"ID": str(spot)})


def _links(model: ElementTree.Element, names: Any, graph: dict[int, list[int]]) -> None:
    """Links within tracks, and from mothers to daughters, which stand first: a track keeps its number."""
    of_track = {int(name): np.flatnonzero(names == name) for name in np.unique(names)}
    shift = 1 if min(of_track) > 0 else 0  # numbers of TrackMate begin at 0
    every = ElementTree.SubElement(model, "AllTracks")
    divisions = [
        (mother, daughter)
        for daughter, mothers in graph.items()
        for mother in mothers
        if mother in of_track and daughter in of_track
    ]
    found = [(int(of_track[a][-1]), int(of_track[b][0]), b) for a, b in divisions]
    for name, spots in of_track.items():
        found += [(one, other, name) for one, other in pairwise(spots.tolist())]
    for one, other, name in found:
        number = str(name - shift)
        track = ElementTree.SubElement(every, "Track", TRACK_ID=number)
        ElementTree.SubElement(
            track, "Edge", SPOT_SOURCE_ID=str(one), SPOT_TARGET_ID=str(other), LINK_COST="-1.0"
        )
    shown = ElementTree.SubElement(model, "FilteredTracks")
    for name in dict.fromkeys(name for *_, name in found):
        ElementTree.SubElement(shown, "TrackID", TRACK_ID=str(name - shift))
