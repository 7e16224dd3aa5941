"""Matplotlib pictures of cells, their disks and their windows; functions take Axes and return artists.

A mask and its disk: draw_cell, draw_outline, draw_mesh, draw_area_distortion; draw_disk_image,
draw_disk_mesh.

Windows: draw_windows, draw_window_means, draw_window_labels, draw_sectors, draw_strip on the cell;
draw_disk_windows, draw_disk_means on the disk; frame_cell fits axes to a cell.

Movies: draw_activity_map, draw_velocity_map, draw_layers by frame and sector; draw_line_kymograph and
draw_boundary_kymograph; draw_velocity_arrows, draw_tracks, draw_area_change and draw_mean_velocity of the
edge; draw_by_layer for lines of layers; write_animation.

Correlations: draw_correlation_curves with curve_key, draw_map_pair, draw_pairs; PeakMap for
draw_peaks_on_cell and draw_peaks_on_disk with peak_key; draw_events, draw_event_average with band_key.

Shapes: shape_landscape, the plane of the complexity score; shape_examples, cells by their outlines.

Whole pages into the folder of a study: draw_cell_figures, draw_movie_figures, draw_correlation_figures,
draw_shape_figures, draw_overview; of a comparison of windows: draw_comparison, draw_compared_cells,
draw_compared_movie.

Looks: paper_style for the sizes of a printed page, colour_bar, scale_bar.
"""

from importlib import import_module
from typing import Any

_HOME = {
    "band_key": "events",
    "colour_bar": "style",
    "curve_key": "correlation",
    "draw_activity_map": "kymograph",
    "draw_area_change": "edge",
    "draw_area_distortion": "cell",
    "draw_boundary_kymograph": "line_kymograph",
    "draw_by_layer": "consistency",
    "draw_cell": "cell",
    "draw_cell_figures": "study",
    "draw_compared_cells": "compared_cells",
    "draw_compared_movie": "compared_movie",
    "draw_comparison": "comparison",
    "draw_correlation_curves": "correlation",
    "draw_correlation_figures": "correlation_figures",
    "draw_disk_image": "disk",
    "draw_disk_means": "disk",
    "draw_disk_mesh": "disk",
    "draw_disk_windows": "disk",
    "draw_event_average": "events",
    "draw_events": "events",
    "draw_layers": "kymograph",
    "draw_line_kymograph": "line_kymograph",
    "draw_map_pair": "correlation",
    "draw_mean_velocity": "movie_edge",
    "draw_mesh": "cell",
    "draw_movie_figures": "movie",
    "draw_outline": "cell",
    "draw_overview": "overview",
    "draw_pairs": "pairs",
    "draw_peaks_on_cell": "correlation_cell",
    "draw_peaks_on_disk": "correlation_cell",
    "draw_sectors": "strip",
    "draw_shape_figures": "shape_figures",
    "draw_strip": "strip",
    "draw_tracks": "edge",
    "draw_velocity_arrows": "edge",
    "draw_velocity_map": "kymograph",
    "draw_window_labels": "window_labels",
    "draw_window_means": "cell",
    "draw_windows": "cell",
    "frame_cell": "cell",
    "paper_style": "style",
    "peak_key": "correlation_cell",
    "PeakMap": "correlation_cell",
    "scale_bar": "style",
    "shape_examples": "shape_rows",
    "shape_landscape": "shape_plane",
    "write_animation": "animation",
}

__all__ = sorted(_HOME)


def __getattr__(name: str) -> Any:
    if name in _HOME:
        return getattr(import_module(f"cytodisk.plot.{_HOME[name]}"), name)
    raise AttributeError(f"module 'cytodisk.plot' has no attribute {name!r}")


def __dir__() -> list[str]:
    return __all__
