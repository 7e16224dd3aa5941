"""cytodisk: any cell, any moment, one disk."""

from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from cytodisk.files import keep_kernels

if TYPE_CHECKING:
    from cytodisk import errors as errors
    from cytodisk import plot as plot
    from cytodisk import simulate as simulate
    from cytodisk.analysis.activity import sample_movie as sample_movie
    from cytodisk.analysis.consistency import centroid_displacement as centroid_displacement
    from cytodisk.analysis.consistency import consecutive_correlation as consecutive_correlation
    from cytodisk.analysis.correlation import correlation_by_layer as correlation_by_layer
    from cytodisk.analysis.correlation import cross_correlate as cross_correlate
    from cytodisk.analysis.distances import window_distances as window_distances
    from cytodisk.analysis.event_average import average_around as average_around
    from cytodisk.analysis.events import edge_events as edge_events
    from cytodisk.analysis.jitter import jitter_step as jitter_step
    from cytodisk.analysis.kymograph import boundary_kymograph as boundary_kymograph
    from cytodisk.analysis.kymograph import line_kymograph as line_kymograph
    from cytodisk.analysis.pairs import correlate_pairs as correlate_pairs
    from cytodisk.analysis.peaks import peak_correlation as peak_correlation
    from cytodisk.analysis.series import prepare_series as prepare_series
    from cytodisk.analysis.shape.complexity import complexity_score as complexity_score
    from cytodisk.analysis.shape.features import shape_features as shape_features
    from cytodisk.analysis.window_measures import measures_by_layer as measures_by_layer
    from cytodisk.analysis.window_measures import window_measures as window_measures
    from cytodisk.disk.certificate import Certificate as Certificate
    from cytodisk.disk.certificate import certify as certify
    from cytodisk.disk.disk_map import DiskMap as DiskMap
    from cytodisk.disk.disk_map import load_map as load_map
    from cytodisk.disk.distortion import Distortion as Distortion
    from cytodisk.disk.mapping import map_to_disk as map_to_disk
    from cytodisk.geometry.mask import MaskReport as MaskReport
    from cytodisk.geometry.mask import clean_mask as clean_mask
    from cytodisk.io.frames import read_image as read_image
    from cytodisk.io.study import Study as Study
    from cytodisk.io.study import open_study as open_study
    from cytodisk.motion.demons import DemonsParameters as DemonsParameters
    from cytodisk.motion.disk_movie import DiskMovie as DiskMovie
    from cytodisk.motion.map_movie import map_movie as map_movie
    from cytodisk.motion.velocity import boundary_velocity as boundary_velocity
    from cytodisk.motion.velocity import edge_changes as edge_changes
    from cytodisk.motion.velocity import edge_velocity as edge_velocity
    from cytodisk.report.flags import red_flags as red_flags
    from cytodisk.report.page import write_report as write_report
    from cytodisk.study.compare_cells import compare_cells as compare_cells
    from cytodisk.study.compare_movie import compare_movie as compare_movie
    from cytodisk.study.compare_parameters import CompareMovieParameters as CompareMovieParameters
    from cytodisk.study.compare_parameters import CompareParameters as CompareParameters
    from cytodisk.study.comparison import Comparison as Comparison
    from cytodisk.study.comparison import open_comparison as open_comparison
    from cytodisk.study.correlate import correlate_study as correlate_study
    from cytodisk.study.shape_tables import open_shapes as open_shapes
    from cytodisk.windows.cell_windows import CellWindows as CellWindows
    from cytodisk.windows.edge_windows import EdgeGrid as EdgeGrid
    from cytodisk.windows.edge_windows import EdgeWindows as EdgeWindows
    from cytodisk.windows.edge_windows import edge_windows as edge_windows
    from cytodisk.windows.grid import PolarWindows as PolarWindows
    from cytodisk.windows.grid import polar_windows as polar_windows
    from cytodisk.windows.on_cell import WindowsOnCell as WindowsOnCell
    from cytodisk.windows.ring_windows import RingGrid as RingGrid
    from cytodisk.windows.ring_windows import RingWindows as RingWindows
    from cytodisk.windows.ring_windows import ring_windows as ring_windows
    from cytodisk.windows.sample import sample as sample

__version__ = "0.1.0"

_HOME = {
    "average_around": "analysis.event_average",
    "boundary_kymograph": "analysis.kymograph",
    "boundary_velocity": "motion.velocity",
    "CellWindows": "windows.cell_windows",
    "centroid_displacement": "analysis.consistency",
    "Certificate": "disk.certificate",
    "certify": "disk.certificate",
    "clean_mask": "geometry.mask",
    "complexity_score": "analysis.shape.complexity",
    "compare_cells": "study.compare_cells",
    "compare_movie": "study.compare_movie",
    "CompareMovieParameters": "study.compare_parameters",
    "CompareParameters": "study.compare_parameters",
    "Comparison": "study.comparison",
    "consecutive_correlation": "analysis.consistency",
    "correlate_pairs": "analysis.pairs",
    "correlate_study": "study.correlate",
    "correlation_by_layer": "analysis.correlation",
    "cross_correlate": "analysis.correlation",
    "DemonsParameters": "motion.demons",
    "DiskMap": "disk.disk_map",
    "DiskMovie": "motion.disk_movie",
    "Distortion": "disk.distortion",
    "edge_events": "analysis.events",
    "edge_changes": "motion.velocity",
    "edge_velocity": "motion.velocity",
    "edge_windows": "windows.edge_windows",
    "EdgeGrid": "windows.edge_windows",
    "EdgeWindows": "windows.edge_windows",
    "jitter_step": "analysis.jitter",
    "line_kymograph": "analysis.kymograph",
    "load_map": "disk.disk_map",
    "map_movie": "motion.map_movie",
    "map_to_disk": "disk.mapping",
    "MaskReport": "geometry.mask",
    "measures_by_layer": "analysis.window_measures",
    "open_comparison": "study.comparison",
    "open_shapes": "study.shape_tables",
    "open_study": "io.study",
    "peak_correlation": "analysis.peaks",
    "polar_windows": "windows.grid",
    "PolarWindows": "windows.grid",
    "prepare_series": "analysis.series",
    "read_image": "io.frames",
    "red_flags": "report.flags",
    "ring_windows": "windows.ring_windows",
    "RingGrid": "windows.ring_windows",
    "RingWindows": "windows.ring_windows",
    "sample": "windows.sample",
    "sample_movie": "analysis.activity",
    "shape_features": "analysis.shape.features",
    "Study": "io.study",
    "window_distances": "analysis.distances",
    "window_measures": "analysis.window_measures",
    "WindowsOnCell": "windows.on_cell",
    "write_report": "report.page",
}
_MODULES = ("errors", "plot", "simulate")

__all__ = sorted([*_HOME, *_MODULES])

keep_kernels(Path(__file__).parent)


def __getattr__(name: str) -> Any:
    if name in _MODULES:
        return import_module(f"cytodisk.{name}")
    if name in _HOME:
        return getattr(import_module(f"cytodisk.{_HOME[name]}"), name)
    raise AttributeError(f"module 'cytodisk' has no attribute {name!r}")


def __dir__() -> list[str]:
    return [*__all__, "__version__"]
