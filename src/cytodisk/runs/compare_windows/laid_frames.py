"""Windows of each method on the frames of a movie."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from cytodisk.analysis.activity import Grid
from cytodisk.disk.disk_map import DiskMap
from cytodisk.motion.disk_movie import DiskMovie
from cytodisk.motion.nonrigid.nonrigid_parameters import NonrigidParameters
from cytodisk.motion.nonrigid.reference_field import fields_to_reference
from cytodisk.taking import takes
from cytodisk.windows.carried_windows import CarriedWindows
from cytodisk.windows.edge_windows import CellEdge
from cytodisk.windows.on_cell import WindowsOnCell
from cytodisk.windows.polar_windows import PolarGrid
from cytodisk.windows.springs.edge_beads import EdgeBeads
from cytodisk.windows.springs.spring_parameters import LineTensionParameters
from cytodisk.windows.springs.spring_windows import SpringGrid, SpringWindows


@dataclass(frozen=True, eq=False)
class LaidFrame:
    """One frame with its windows.

    Attributes
    ----------
    frame : int
        Its place in the movie, from 0.
    disk : DiskMap
    windows : WindowsOnCell
    shares : dict of str to float
        What a registration did, by the name of the column: "folded" and "carried_outside".
    """

    frame: int
    disk: DiskMap
    windows: WindowsOnCell
    shares: dict[str, float] = field(default_factory=dict)


@takes(LineTensionParameters)
def lay_frames(method: str, movie: DiskMovie, grid: Grid, **settings: float) -> Iterator[LaidFrame]:
    """Windows of a method on each frame that has a cell.

    Parameters
    ----------
    method : str
    movie : DiskMovie
    grid : Grid
        Of the method.
    **settings
        See `LineTensionParameters`; only windows with springs need them.

    Yields
    ------
    LaidFrame
    """
    if method == "springs" and isinstance(grid, SpringGrid):
        yield from spring_frames(movie, grid, **settings)
    elif method == "registered" and isinstance(grid, PolarGrid):
        yield from registered_frames(movie, grid)
    else:
        for frame in np.flatnonzero(movie.mapped).tolist():
            disk = movie[frame]
            yield LaidFrame(frame, disk, grid.on(disk))


@takes(LineTensionParameters)
def spring_frames(movie: DiskMovie, grid: SpringGrid, **settings: float) -> Iterator[LaidFrame]:
    """Windows with springs, on an edge that is followed by line tension of its own.

    Parameters
    ----------
    movie : DiskMovie
        Its outlines and their rigid motion are used, its tracked points are not.
    grid : SpringGrid
    **settings
        See `LineTensionParameters`.

    Yields
    ------
    LaidFrame
    """
    line_tension = LineTensionParameters.of(**settings).line_tension
    beads: EdgeBeads | None = None
    for frame, record in enumerate(movie.records):
        if record.boundary is None:
            continue
        disk, found = movie[frame], record.boundary
        outline = found.transform.of(found.contour).points_yx
        if beads is None:
            beads = EdgeBeads.along(outline, disk.boundary_angles, grid.sectors)
        else:
            beads = beads.carried(outline, line_tension)
        edge = CellEdge(disk.mask, disk.outline_yx, beads.angles, disk.scale, disk.holes)
        yield LaidFrame(frame, disk, SpringWindows(grid, edge))


@takes(NonrigidParameters)
def registered_frames(movie: DiskMovie, grid: PolarGrid, **settings: float) -> Iterator[LaidFrame]:
    """Windows of the first frame, carried to each other one by a registration of the masks.

    Parameters
    ----------
    movie : DiskMovie
        The map of its first frame is used; of the others the masks and their rigid motion.
    grid : PolarGrid
    **settings
        See `NonrigidParameters`.

    Yields
    ------
    LaidFrame
    """
    reference: DiskMap | None = None
    for registered in fields_to_reference(movie, **settings):
        disk = movie[registered.frame]
        reference = disk if reference is None else reference
        windows = CarriedWindows(grid, disk, reference, registered.to_reference)
        shares = {"folded": registered.folded, "carried_outside": registered.outside}
        yield LaidFrame(registered.frame, disk, windows, shares)
