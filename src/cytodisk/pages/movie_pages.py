"""The pictures of one cell of a movie's study."""

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from cytodisk.arrays import FloatArray
from cytodisk.errors import ReadError
from cytodisk.pages.animation import write_animation
from cytodisk.pages.consistency_page import consistency_sheet
from cytodisk.pages.drawn_movie import LEFT_MM, DrawnMovie
from cytodisk.pages.edge_page import edge_sheet
from cytodisk.pages.figure_formats import chosen_formats, save_in_formats
from cytodisk.pages.profile_page import profile_sheet
from cytodisk.pages.sheet import Sheet
from cytodisk.plot.cell.frame_strip import draw_strip
from cytodisk.plot.field_of_view import field_of_view
from cytodisk.plot.layer_looks import shown_layers
from cytodisk.plot.movie.activity_maps import draw_layers, draw_velocity_map
from cytodisk.plot.style import WIDE_MM, colour_bar, paper_style, signal_limits
from cytodisk.plot.time_axis import time_stamp
from cytodisk.plot.time_raster import bar_beside
from cytodisk.runs.channel_names import file_names
from cytodisk.store.figures_folder import drawing
from cytodisk.store.study import Study

SignalAt = Callable[[int], Any]
Progress = Callable[[int, int], None]

MOST_ANIMATED = 60  # frames; more make long files
_STRIP_FRAMES, _STRIP_COLUMNS = 6, 3
_MAP_LEFT, _MAP_WIDTH, _VELOCITY, _MAP, _MAP_GAP = 13.0, 87.0, 30.0, 23.0, 5.5  # mm
_TALLEST = 1.3  # height of a panel of the strip over its width


def write_movie_figures(
    study: Study,
    cell: int,
    signal: SignalAt | None = None,
    *,
    animation: bool = True,
    formats: Sequence[str] = ("png",),
    progress: Progress | None = None,
) -> list[Path]:
    """Write the pictures of one cell of a movie into the study's folder of figures.

    They are activity maps of each channel (without a signal the map of edge velocity alone), with a nucleus
    the signal from the nucleus to the membrane, the motion of the edge, windows on the cell in a few frames,
    consistency, and last an animation of cell and disk.
    Frames without a map are gaps in the maps, and left out elsewhere; what a cell has too few frames for is
    not drawn.

    Parameters
    ----------
    study : Study
        Study of a movie.
    cell : int
        Its number in the tables.
    signal : callable, optional
        Gives the image of a frame, shape (C, H, W), by the recording's frame number, or None if it has none;
        is asked for the few frames drawn, one at a time. The first channel is the background of the windows.
    animation : bool
        Whether to write the animation, which takes longest: at most 60 frames, evenly spaced. It is a GIF.
    formats : sequence of {"png", "pdf", "svg"}
        Of all other pictures. Text stays text in the last two.
    progress : callable, optional
        Called with (done, in all), counted in pages and frames of the animation.

    Returns
    -------
    list of Path
        The files written: `cell_<number>_<what>.<format>`, 119 mm wide, and `cell_<number>.gif`. Empty when
        no frame has a map.

    Raises
    ------
    ParameterError
        A format is unknown.
    ReadError
        The study is not a movie's, has no such cell, or a map of it is damaged.
    SignalError
        An image has another shape than the masks.
    StudyError
        The folder cannot be written.

    See Also
    --------
    write_animation : The animated picture alone.
    write_correlation_figures : Pictures of a correlation.

    Examples
    --------
    >>> import tifffile
    >>> import cytodisk as cd
    >>> truth = cd.simulate.movie("growing", frames=5, radius_px=12.0)
    >>> tifffile.imwrite("masks.tif", truth.masks.astype("uint8"), metadata={"axes": "TYX"})
    >>> study = cd.run_movie("masks.tif", "out", layers=2, sectors=6)
    >>> [path.name for path in cd.pages.write_movie_figures(study, 0, animation=False)]
    ['cell_00000_velocity.png', 'cell_00000_edge.png', 'cell_00000_strip.png', 'cell_00000_consistency.png']
    """
    chosen = chosen_formats(formats)
    movie = DrawnMovie(study, cell)
    if not movie.mapped:
        return []
    pages = _pages(movie, signal)
    frames = _evenly(movie.mapped, MOST_ANIMATED) if animation else []
    report = progress or (lambda done, whole: None)
    whole, paths = len(pages) + len(frames), []
    names = [movie.path(f"_{what}.{kind}").name for what, _ in pages for kind in chosen]
    names += [movie.path(".gif").name] * animation
    with drawing(study.path, *names) as folder:
        for done, (what, draw) in enumerate(pages):
            report(done, whole)
            with paper_style():
                sheet = draw()
                if sheet is not None:
                    paths += save_in_formats(sheet, folder, movie.path(f"_{what}").name, chosen)
        if frames:
            paths.append(_animate(movie, signal, frames, lambda done: report(len(pages) + done, whole)))
    report(whole, whole)
    return paths


def _pages(movie: DrawnMovie, signal: SignalAt | None) -> list[tuple[str, Callable[[], Sheet | None]]]:
    """Name of each page, and what draws it."""
    pages: list[tuple[str, Callable[[], Sheet | None]]] = []
    if not movie.channels:
        pages.append(("velocity", partial(_velocity_sheet, movie)))
    for number, name in enumerate(file_names(movie.channels)):
        pages.append((f"activity_{name}", partial(_activity_sheet, movie, number)))
    if movie.channels and movie.cytoplasm_layers is not None:
        pages.append(("profile", partial(profile_sheet, movie)))
    pages.append(("edge", partial(edge_sheet, movie)))
    pages.append(("strip", partial(_strip_sheet, movie, signal)))
    pages.append(("consistency", partial(consistency_sheet, movie)))
    return pages


def _velocity_sheet(movie: DrawnMovie) -> Sheet:
    sheet = Sheet(movie.heading_mm + 6.0 + 2 * _VELOCITY + 12.0)
    movie.write_heading(sheet, "edge velocity")
    ax = sheet.axes(_MAP_LEFT, movie.heading_mm + 6.0, _MAP_WIDTH, 2 * _VELOCITY)
    draw_velocity_map(ax, movie.activity["velocity"], scale=movie.scale)
    ax.set_title("edge velocity: protrusion red, retraction blue", loc="left", y=1.0, pad=2.5)
    return sheet


def _activity_sheet(movie: DrawnMovie, channel: int) -> Sheet:
    layers = len(shown_layers(movie.grid.layers, movie.cytoplasm_layers))
    first = movie.heading_mm + 5.0
    below = first + _VELOCITY + _MAP_GAP
    sheet = Sheet(below + layers * (_MAP + _MAP_GAP) + 5.0)
    name = movie.shown_name(channel)
    movie.write_heading(sheet, f"activity of {name}")
    maps = [sheet.axes(_MAP_LEFT, below + k * (_MAP + _MAP_GAP), _MAP_WIDTH, _MAP) for k in range(layers)]
    draw_layers(
        [sheet.axes(_MAP_LEFT, first, _MAP_WIDTH, _VELOCITY), *maps],
        movie.activity["mean"][:, channel],
        movie.activity["velocity"],
        label=f"mean {name}",
        scale=movie.scale,
        depths=movie.depths,
    )
    return sheet


def _strip_sheet(movie: DrawnMovie, signal: SignalAt | None) -> Sheet:
    frames = _spread(movie.mapped, _STRIP_FRAMES)
    images = [_background(signal, frame) for frame in frames]
    shown = [image for image in images if image is not None]
    extent = field_of_view([movie.points_yx])
    wide, right = extent[3] - extent[2], 15.0 if shown else 0.0
    width = (WIDE_MM - 2 * LEFT_MM - right - 3.0 * (_STRIP_COLUMNS - 1)) / _STRIP_COLUMNS
    height = width * min((extent[1] - extent[0]) / wide, _TALLEST)
    rows = -(-len(frames) // _STRIP_COLUMNS)
    sheet = Sheet(movie.heading_mm + rows * (height + 10.0) + 1.0)
    movie.write_heading(sheet, "windows through time" + (f", over {movie.shown_name()}" if shown else ""))
    axes = [
        sheet.axes(
            LEFT_MM + (k % _STRIP_COLUMNS) * (width + 3.0),
            movie.heading_mm + 4.5 + (k // _STRIP_COLUMNS) * (height + 10.0),
            width,
            height,
        )
        for k in range(len(frames))
    ]
    windows = [movie.windows(frame) for frame in frames]
    stamps = [time_stamp(frame, movie.scale) for frame in frames]
    # A frame without its image stays blank below its windows, as its neighbours keep their colours.
    missing = np.full(movie.maps.image_shape, np.nan)
    draw_strip(
        axes,
        windows,
        stamps,
        extent_yx=extent,
        scale=movie.scale,
        signal=[missing if image is None else image for image in images] if shown else None,
    )
    if shown:
        beside = bar_beside(axes[min(_STRIP_COLUMNS, len(axes)) - 1])
        colour_bar(axes[0].images[0], beside, movie.shown_name(), "a.u.", extend="both")
    return sheet


def _animate(
    movie: DrawnMovie, signal: SignalAt | None, frames: list[int], progress: Callable[[int], None]
) -> Path:
    def drawn() -> Iterator[tuple[Any, FloatArray | None, int]]:
        for frame in frames:
            yield movie.windows(frame), _background(signal, frame), frame

    return write_animation(
        movie.path(".gif"),
        drawn(),
        extent_yx=field_of_view([movie.points_yx]),
        scale=movie.scale,
        limits=_limits(movie, signal),
        label=f"{movie.shown_name()} (a.u.)",
        progress=progress,
    )


def _limits(movie: DrawnMovie, signal: SignalAt | None) -> tuple[float, float] | None:
    """Colours that suit first, middle and last frame alike."""
    inside = []
    for frame in _spread(movie.mapped, 3):
        image = _background(signal, frame)
        if image is not None and image.shape == movie.maps.image_shape:
            inside.append(image[movie.maps[frame].mask_without_holes])
    if not inside:
        return None
    return signal_limits(np.concatenate(inside))


def _background(signal: SignalAt | None, frame: int) -> FloatArray | None:
    """First channel of a frame's image, if it has one that can be read."""
    image = None if signal is None else signal(frame)
    if image is None or isinstance(image, ReadError):
        return None
    values = np.asarray(image, dtype=np.float64)
    return values if values.ndim == 2 else values[0]


def _spread(frames: list[int], most: int) -> list[int]:
    """First, last, and as many between as wanted."""
    chosen = np.linspace(0, len(frames) - 1, min(most, len(frames))).round().astype(int)
    return [frames[k] for k in chosen]


def _evenly(frames: list[int], most: int) -> list[int]:
    """Every k-th, so that at most so many are left."""
    return frames[:: -(-len(frames) // most)]
