"""Files of outlines as their programs write them."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

Ring = list[tuple[float, float]]  # (x, y), from the corner of the first pixel

SQUARE: Ring = [(3, 2), (13, 2), (13, 12), (3, 12)]
RIGHT: Ring = [(20, 4), (30, 4), (30, 14), (20, 14)]


def rectangle(shape: tuple[int, int], *rings: Ring) -> np.ndarray:
    """Labels of rectangles from corner to corner, numbered from 1."""
    labels = np.zeros(shape, dtype=int)
    for number, ring in enumerate(rings, start=1):
        (left, top), (right, bottom) = np.min(ring, axis=0), np.max(ring, axis=0)
        labels[top:bottom, left:right] = number
    return labels


def feature(*rings: Ring, plane: dict[str, int] | None = None, **properties: Any) -> dict[str, Any]:
    """An object of QuPath; rings after the first are holes."""
    geometry: dict[str, Any] = {"type": "Polygon", "coordinates": [[*ring, ring[0]] for ring in rings]}
    if plane is not None:
        geometry["plane"] = {"c": -1, "z": 0, "t": 0} | plane
    about = {"objectType": "annotation", "isLocked": False} | properties
    return {"type": "Feature", "id": "a1b2", "geometry": geometry, "properties": about}


def write_geojson(path: Path, *features: dict[str, Any]) -> Path:
    """As QuPath exports objects."""
    path.write_text(json.dumps({"type": "FeatureCollection", "features": list(features)}))
    return path


def write_stardist_rois(path: Path, coordinates: list[np.ndarray]) -> Path:
    """As `stardist.export_imagej_rois` writes polygons (rows, columns), pixel centres at integers."""
    roifile = __import__("roifile")
    rois = []
    for number, (rows, columns) in enumerate(coordinates, start=1):
        roi = roifile.ImagejRoi.frompoints(np.column_stack([columns, rows]) + 0.5, name="")
        roi.roitype, roi.position, roi.name = roifile.ROI_TYPE.POLYGON, 1, f"001_{number:03d}"
        rois.append(roi)
    roifile.roiwrite(path, rois, name=[f"{roi.name}.roi" for roi in rois])
    return path


def trackmate_xml(
    spots: list[dict[str, Any]], links: list[tuple[int, int, int]], *, unit: str = "pixel", size: float = 1.0
) -> str:
    """A session of TrackMate: spots with id, frame, x, y, polygon; links (spot, spot, track)."""
    frames: dict[int, list[str]] = {}
    for spot in spots:
        polygon = spot.get("polygon")
        outline, points = "", ""
        if polygon is not None:
            points = f' ROI_N_POINTS="{len(polygon)}"'
            outline = " ".join(f"{x - spot['x']} {y - spot['y']}" for x, y in polygon)
        frames.setdefault(spot["frame"], []).append(
            f'<Spot ID="{spot["id"]}" name="ID{spot["id"]}" RADIUS="{spot.get("radius", 5.0)}" '
            f'VISIBILITY="1" QUALITY="1.0" POSITION_T="{spot["frame"]}.0" '
            f'POSITION_X="{spot["x"]}" POSITION_Y="{spot["y"]}" '
            f'FRAME="{spot["frame"]}" POSITION_Z="0.0"{points}>{outline}</Spot>'
        )
    tracks: dict[int, list[str]] = {}
    for one, other, track in links:
        edge = f'<Edge SPOT_SOURCE_ID="{one}" SPOT_TARGET_ID="{other}" LINK_COST="1.0" />'
        tracks.setdefault(track, []).append(edge)
    n_frames = max(frames) + 1
    return "\n".join(
        [
            '<?xml version="1.0" encoding="UTF-8"?>',
            '<TrackMate version="7.11.1">',
            f'<Log>Done.</Log><Model spatialunits="{unit}" timeunits="sec">',
            "<FeatureDeclarations><SpotFeatures /></FeatureDeclarations>",
            f'<AllSpots nspots="{len(spots)}">',
            *(
                f'<SpotsInFrame frame="{frame}">{"".join(held)}</SpotsInFrame>'
                for frame, held in frames.items()
            ),
            "</AllSpots><AllTracks>",
            *(
                f'<Track name="Track_{track}" TRACK_INDEX="{track}" TRACK_ID="{track}">'
                f"{''.join(held)}</Track>"
                for track, held in tracks.items()
            ),
            "</AllTracks><FilteredTracks>",
            *(f'<TrackID TRACK_ID="{track}" />' for track in tracks),
            "</FilteredTracks></Model>",
            '<Settings><ImageData filename="a.tif" folder="/data/" width="40" height="30" nslices="1" '
            f'nframes="{n_frames}" pixelwidth="{size}" pixelheight="{size}" voxeldepth="1.0" '
            'timeinterval="2.0" />',
            "</Settings></TrackMate>",
        ]
    )


def write_geff(path: Path, nodes: dict[str, Any], edges: list[tuple[int, int]], **about: Any) -> Path:
    """As the geff library writes tracks: properties of nodes by name, `id` among them."""
    zarr = __import__("zarr")
    zarr_format = about.pop("zarr_format", 2)
    group = zarr.open_group(str(path), mode="w", zarr_format=zarr_format)
    axes = [{"name": "t", "type": "time", "unit": "frame"}]
    axes += [{"name": name, "type": "space", "unit": about.pop("unit", "pixel")} for name in "yx"[:1]]
    axes += [{"name": "x", "type": "space", "unit": axes[1]["unit"]}]
    metadata = {"geff_version": "1.3", "directed": True, "axes": axes, "track_node_props": None} | about
    group.attrs["geff"] = {name: value for name, value in metadata.items() if value != "left out"}
    ids = np.array(nodes["id"], dtype=np.uint64)
    group.create_array("nodes/ids", data=ids)
    group.create_array("edges/ids", data=np.array(edges, dtype=np.uint64).reshape(-1, 2))
    for name, values in nodes.items():
        if name != "id":
            missing = np.array([value is None for value in values])
            filled = np.array([0 if value is None else value for value in values])
            group.create_array(f"nodes/props/{name}/values", data=filled)
            if missing.any():
                group.create_array(f"nodes/props/{name}/missing", data=missing)
    return path
