"""Write a movie of a cell beside its disk, frame by frame, so that long movies need little memory."""

import os
import shutil
import subprocess
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from PIL import Image

from cytodisk.errors import ParameterError, StudyError
from cytodisk.files import replacing
from cytodisk.pages.animated_frame import AnimatedFrames
from cytodisk.plot.field_of_view import Extent
from cytodisk.plot.time_axis import time_stamp
from cytodisk.plot.units import scale_for
from cytodisk.scale import Scale
from cytodisk.windows.polar_windows import CellWindows

MOST_FRAMES = 150

Frame = tuple[CellWindows, Any, int]


def write_animation(
    path: str | os.PathLike[str],
    frames: Iterable[Frame],
    *,
    extent_yx: Extent,
    fps: float = 8,
    scale: Scale | None = None,
    limits: tuple[float, float] | None = None,
    label: str = "signal (a.u.)",
    progress: Callable[[int], None] | None = None,
) -> Path:
    """Write an animated picture: the cell with its windows on the left, its disk on the right.

    Colours along the edge tell the sectors apart, as in `draw_strip`; a frame without a signal has its
    outermost windows filled with them. At most 150 frames are shown: of a longer movie every second, fourth,
    eighth and so on, so that the number of frames need not be known beforehand.

    Parameters
    ----------
    path : path-like
        Ends in `.gif`, or in `.mp4` where the program ffmpeg is installed.
    frames : iterable of (CellWindows, array_like of shape (H, W) or None, int)
        Windows, one channel of the signal, and number of the frame, from 0. Is read once, one at a time.
    extent_yx : (float, float, float, float)
        Field of view: top, bottom, left and right in pixels, such as `field_of_view` gives.
    fps : float
        Frames shown per second.
    scale : Scale, optional
        By default that of the windows. Unknown, the scale bar is in px and the stamp the frame's number.
    limits : (float, float), optional
        Limits of the signal's colours in all frames; by default percentiles 1 and 99.5 inside the first cell.
    label : str
        Label of the colour bar, with its unit.
    progress : callable, optional
        Is called with the number of frames read so far.

    Returns
    -------
    Path
        The file written.

    Raises
    ------
    ParameterError
        The path has another suffix or ffmpeg is missing, there is no frame, the frames have different grids,
        or a number is out of its range.
    SignalError
        A signal has another shape than its mask.
    StudyError
        The file cannot be written.

    See Also
    --------
    write_movie_figures : All pictures of a movie in a study.

    Examples
    --------
    >>> import cytodisk as cd
    >>> truth = cd.simulate.movie("growing", frames=3, radius_px=12.0)
    >>> movie = cd.map_movie(truth.masks)
    >>> grid, signal = cd.polar_windows(layers=3, sectors=8), truth.signal.sel(channel="edge")
    >>> frames = [(grid.on(movie[t]), signal[t], t) for t in range(3)]
    >>> height, width = truth.masks.shape[1:]
    >>> cd.pages.write_animation("cell.gif", frames, extent_yx=(0, height, 0, width)).name
    'cell.gif'
    """
    target = Path(path)
    _check(target, fps)
    images: list[Image.Image] = []
    stage, every = None, 1
    for number, (windows, signal, index) in enumerate(frames):
        if number % every == 0:
            known = scale_for(windows, scale)
            stage = stage or AnimatedFrames(windows.grid, extent_yx, known, limits, label)
            images.append(stage.draw(windows, signal, time_stamp(index, known)))
        if len(images) > MOST_FRAMES:
            images, every = images[::2], 2 * every
        if progress is not None:
            progress(number + 1)
    if not images:
        raise ParameterError("frames is empty: pass at least one frame")
    with replacing(target) as temporary:
        write = _write_gif if target.suffix.lower() == ".gif" else _write_mp4
        write(temporary, images, fps)
    return target


def _check(path: Path, fps: float) -> None:
    suffix = path.suffix.lower()
    if suffix not in (".gif", ".mp4"):
        raise ParameterError(f"path must end in .gif or .mp4, got {path}")
    if suffix == ".mp4" and shutil.which("ffmpeg") is None:
        raise ParameterError(f"{path} needs ffmpeg, which is not installed: install it, or end in .gif")
    if not 0 < fps <= 100:
        raise ParameterError(f"fps must be a number above 0 and at most 100, got {fps!r}")


def _write_gif(path: Path, images: list[Image.Image], fps: float) -> None:
    first, *others = images
    first.save(path, save_all=True, append_images=others, duration=round(1000 / fps), loop=0)


def _write_mp4(path: Path, images: list[Image.Image], fps: float) -> None:
    """H.264 needs sides of even length."""
    width, height = images[0].size
    raw = ["-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{width}x{height}", "-r", f"{fps:g}", "-i", "-"]
    encoded = ["-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white", "-pix_fmt", "yuv420p", str(path)]
    pixels = b"".join(image.convert("RGB").tobytes() for image in images)
    done = subprocess.run(
        ["ffmpeg", "-y", "-loglevel", "error", *raw, *encoded], input=pixels, capture_output=True, check=False
    )
    if done.returncode:
        raise StudyError(f"cannot write {path}: ffmpeg said {done.stderr.decode(errors='replace').strip()}")
