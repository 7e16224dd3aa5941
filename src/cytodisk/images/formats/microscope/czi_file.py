"""CZI files of ZEISS microscopes; needs czifile."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import lru_cache
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np

from cytodisk.errors import MissingPartError, ReadError
from cytodisk.images.chosen_channels import COLOURS
from cytodisk.images.formats.measured_scale import agreed_interval, pixel_size_of
from cytodisk.images.formats.microscope.czi_blocks import Block, block_pixels
from cytodisk.images.formats.microscope.plane_frames import Plane, PlaneFrames, scene_file
from cytodisk.images.formats.microscope.quiet import quiet
from cytodisk.images.frame_file import FileChoice, FrameFile
from cytodisk.images.scenes import Scene, Taken
from cytodisk.scale import Scale

_KNOWN_AXES = {"S", "T", "C", "Z", "Y", "X", "M"}
_AXIS_WORDS = {"H": "phases", "I": "directions of light", "V": "views", "R": "rotations", "B": "blocks"}
WHOLE_BYTES = 2**29
"""A mosaic up to this size is put together as a whole."""

_ALL = slice(None)
_MOST_TIMES = 100  # as much as its pixels fill, a file may claim, for what was left out while recording
_DAYS = (29_000, 90_000)  # days since 1900 of the years 1979 to 2146: some files give times as dates


def open_czi(file: Path, unnamed: str, choice: FileChoice) -> FrameFile:
    """Look at a CZI file without reading its pixels; see `cytodisk.images.frames.open_frames`."""
    contents = _contents(file)

    def stored(scene: Scene, taken: Taken) -> PlaneFrames:
        planes = CziPlanes(file, contents.numbers[taken.scene])
        return PlaneFrames(planes, len(scene.channels), scene.slices, taken.z)

    return scene_file(file, contents.scenes, choice, stored)


def czi_scenes(file: Path) -> tuple[Scene, ...]:
    """What a CZI file holds."""
    return _contents(file).scenes


@dataclass(frozen=True)
class CziPlanes:
    """Planes of one scene; tiles of a mosaic are put where the microscope says, later ones on top.

    Attributes
    ----------
    path : Path
    scene : int
        Its number in the file, which need not start from 0.
    """

    path: Path
    scene: int

    @contextmanager
    def opened(self) -> Iterator[Plane]:
        """Open the file, to read planes of it."""
        contents = _contents(self.path)
        tiles = contents.tiles[self.scene]
        area, samples = contents.areas[self.scene], contents.samples
        with self.path.open("rb") as opened:

            def plane(
                frame: int, channel: int, z: int, rows: slice = _ALL, columns: slice = _ALL, /
            ) -> np.ndarray[Any, Any]:
                key = frame, channel // samples, z
                if key not in tiles:
                    raise ReadError(
                        f"{self.path} has no pixels of frame {key[0]}, channel {key[1]}, slice {key[2]}: "
                        "the recording was stopped, or the file is damaged"
                    )
                shown = _part_of(area[0], rows), _part_of(area[1], columns)
                return _put_together(tiles[key], shown, opened, channel % samples)

            yield plane

    def rows_together(self) -> int | None:
        """How many rows lie in a tile of a large mosaic; None for others, as a cut decodes whole tiles."""
        contents = _contents(self.path)
        tiles, area = next(iter(contents.tiles[self.scene].values())), contents.areas[self.scene]
        size = math.prod(extent.stop - extent.start for extent in area) * tiles[0].dtype.itemsize
        return min(tile.size("Y") for tile in tiles) if len(tiles) > 1 and size > WHOLE_BYTES else None


@dataclass(frozen=True)
class _Contents:
    scenes: tuple[Scene, ...]
    numbers: tuple[int, ...]
    samples: int
    areas: dict[int, tuple[slice, slice]]
    tiles: dict[int, dict[tuple[int, int, int], list[Block]]] = field(repr=False)


def _contents(file: Path) -> _Contents:
    stat = file.stat()
    return _looked_at(file, stat.st_mtime_ns, stat.st_size)


@lru_cache(maxsize=4)
def _looked_at(file: Path, changed: int, size: int) -> _Contents:
    """What a file holds, kept while it does not change: the list of its blocks is long."""
    try:
        import czifile
    except ImportError as error:
        raise MissingPartError.of(f"{file}: reading CZI files needs czifile", "czi") from error
    with quiet("czifile"), czifile.CziFile(str(file)) as opened:
        blocks = [Block.of(entry) for entry in opened.subblock_directory]
        metadata, times, notes = _said(opened)
    whole: dict[int, list[Block]] = {}
    for block in blocks:
        if block.is_whole:
            whole.setdefault(block.start("S"), []).append(block)
    if blocks and not whole:
        raise ReadError(
            f"{file} stores its pixels at another size than it shows them (Airyscan or PALM): save the "
            "processed image in ZEN"
        )
    samples = {block.samples for found in whole.values() for block in found}
    if len(samples) > 1:
        raise ReadError(f"{file} mixes grey and colour images: export them as TIFF, each kind alone")
    numbers = tuple(sorted(whole))
    scenes = (_scene(number, whole[number], metadata, times) for number in numbers)
    return _Contents(
        tuple(replace(scene, notes=(*notes, *scene.notes)) for scene in scenes),
        numbers,
        next(iter(samples), 1),
        {number: _area(found) for number, found in whole.items()},
        {number: _by_plane(found) for number, found in whole.items()},
    )


def _scene(number: int, blocks: list[Block], metadata: ElementTree.Element, times: Sequence[float]) -> Scene:
    sizes = {axis: _extent(blocks, axis) for axis in "TCZ"}
    rows, columns = _area(blocks)
    names = [e.get("Name", "") for e in metadata.iterfind(".//Information/Image/Dimensions/Channels/Channel")]
    if len(names) != sizes["C"]:
        names = [""] * sizes["C"]
    colours = COLOURS.get(blocks[0].samples, ("",))
    size_um, size_notes, fault = pixel_size_of([_distance_um(metadata, axis) for axis in "YX"])
    interval_s, time_notes = _interval(metadata, times, sizes["T"])
    scene_name = next(
        (
            e.get("Name", "")
            for e in metadata.iterfind(".//Information/Image/Dimensions/S/Scenes/Scene")
            if e.get("Index") == str(number)
        ),
        "",
    )
    return Scene(
        scene_name or str(number),
        sizes["T"],
        sizes["Z"],
        tuple(f"{name} {colour}".strip() for name in names for colour in colours),
        (rows.stop - rows.start, columns.stop - columns.start),
        np.result_type(*{block.dtype for block in blocks}),
        Scale(size_um, interval_s),
        size_notes + time_notes,
        fault or _fault(blocks),
    )


def _fault(blocks: list[Block]) -> str:
    """Why planes cannot be told by frame, channel and slice."""
    for axis in sorted({axis for block in blocks for axis in block.axes} - _KNOWN_AXES):
        if (extent := _extent(blocks, axis)) > 1:
            words = _AXIS_WORDS.get(axis, f"places along its axis {axis}")
            return f"holds {extent} {words}: save the processed image, or one of them, in ZEN"
    if any(block.size(axis) > 1 for block in blocks for axis in "TCZ"):
        return "holds lines or spectra, not images: export it as TIFF from ZEN"
    planes = {(block.start("T"), block.start("C"), block.start("Z")) for block in blocks}
    rows, columns = _area(blocks)
    covered = sum(block.size("Y") * block.size("X") for block in blocks) / len(planes)
    claimed = math.prod(_extent(blocks, axis) for axis in "TCZ")
    if (
        min(block.start(axis) for block in blocks for axis in "TCZ") < 0
        or claimed > _MOST_TIMES * len(planes)
        or (rows.stop - rows.start) * (columns.stop - columns.start) > _MOST_TIMES * covered
    ):
        return f"is damaged: its list of {len(blocks)} blocks of pixels makes no sense; copy it again"
    if any(block.dtype.kind == "c" for block in blocks):
        return "holds complex numbers: export it as TIFF from ZEN"
    return ""


def _extent(blocks: list[Block], axis: str) -> int:
    starts = [block.start(axis) for block in blocks]
    return max(starts) + 1 - (min(starts) if axis not in "TCZ" else 0)


def _area(blocks: list[Block]) -> tuple[slice, slice]:
    """Rows and columns that the tiles of a scene cover."""
    return tuple(  # type: ignore[return-value]
        slice(
            min(block.start(axis) for block in blocks),
            max(block.start(axis) + block.size(axis) for block in blocks),
        )
        for axis in "YX"
    )


def _by_plane(blocks: list[Block]) -> dict[tuple[int, int, int], list[Block]]:
    planes: dict[tuple[int, int, int], list[Block]] = {}
    for block in sorted(blocks, key=lambda block: block.start("M")):
        planes.setdefault((block.start("T"), block.start("C"), block.start("Z")), []).append(block)
    return planes


def _put_together(
    tiles: list[Block], area: tuple[slice, slice], opened: Any, sample: int
) -> np.ndarray[Any, Any]:
    """Rows and columns of a plane out of its tiles; those without a tile are 0."""
    rows, columns = area
    shape = rows.stop - rows.start, columns.stop - columns.start
    image = np.zeros(shape, np.result_type(*{tile.dtype for tile in tiles}))
    for tile in tiles:
        above, left = tile.start("Y"), tile.start("X")
        top, bottom = max(rows.start, above), min(rows.stop, above + tile.size("Y"))
        first, last = max(columns.start, left), min(columns.stop, left + tile.size("X"))
        if top < bottom and first < last:
            pixels = block_pixels(tile, opened)[top - above : bottom - above, first - left : last - left]
            inside = slice(top - rows.start, bottom - rows.start)
            image[inside, first - columns.start : last - columns.start] = pixels[..., sample]
    return image


def _part_of(whole: slice, part: slice) -> slice:
    """A part of an extent, which is counted from its start."""
    start, stop, _ = part.indices(whole.stop - whole.start)
    return slice(whole.start + start, whole.start + stop)


def _distance_um(metadata: ElementTree.Element, axis: str) -> float | None:
    for item in metadata.iterfind(".//Scaling/Items/Distance"):
        if item.get("Id") == axis:
            return _number(item.findtext("Value"), 1e6)
    return None


def _interval(
    metadata: ElementTree.Element, attached: Sequence[float], frames: int
) -> tuple[float | None, tuple[str, ...]]:
    """Frame interval from the times of frames, or else the one that was set."""
    if frames < 2:
        return None, ()
    positions = metadata.find(".//Information/Image/Dimensions/T/Positions")
    listed = [] if positions is None else (positions.findtext("List/Offsets") or "").split()
    times = [number for text in listed if (number := _number(text)) is not None]
    if len(times) != frames and len(attached) == frames:
        times = [float(time) for time in attached]
        if _DAYS[0] < min(times) and max(times) < _DAYS[1] and max(times) - min(times) < frames:
            return None, (
                "the times of its frames may be seconds or days: the frame interval is unknown; give it with "
                "--frame-interval",
            )
    increment = None if positions is None else _number(positions.findtext("Interval/Increment"))
    return agreed_interval(times, increment, frames)


def _said(opened: Any) -> tuple[ElementTree.Element, tuple[float, ...], tuple[str, ...]]:
    """Metadata and times of frames; empty with a note where they are damaged, as pixels do not need them."""
    try:
        return ElementTree.fromstring(opened.metadata() or "<ImageDocument/>"), _attached_times(opened), ()
    except Exception as error:  # noqa: BLE001  whatever broken metadata raise, the pixels are there
        words = " ".join(str(error).split()) or type(error).__name__
        note = (
            f"its metadata are damaged ({words}): scale and names of channels are unknown; give them with "
            "--pixel-size, --frame-interval and --channels"
        )
        return ElementTree.Element("ImageDocument"), (), (note,)


def _attached_times(opened: Any) -> tuple[float, ...]:
    for attachment in opened.attachments():
        if attachment.attachment_entry.name == "TimeStamps":
            return tuple(float(time) for time in attachment.data())
    return ()


def _number(text: str | None, factor: float = 1.0) -> float | None:
    try:
        return None if text is None else float(text) * factor
    except ValueError:
        return None
