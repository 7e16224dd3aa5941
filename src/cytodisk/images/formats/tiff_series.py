"""Which pages of a TIFF make the image that is read, where its metadata and its pages agree, or do not."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import tifffile

from cytodisk.errors import ReadError
from cytodisk.images.formats.ome_xml import OmeError, OmeImage, ome_images
from cytodisk.images.formats.tiff_pages import tiff_opened
from cytodisk.images.scenes import place_of

_MOST_PLANES = 10_000_000  # each takes 100 bytes of a file at least
_NAMES = {"ome": "OME", "imagej": "ImageJ", "shaped": "tifffile"}
_OWN_LAYOUT = ("ome", "imagej", "shaped", "generic", "uniform")


@dataclass(frozen=True)
class TiffSeries:
    """The image of a TIFF that is read.

    Attributes
    ----------
    number : int
        Among the series of the file.
    plain : bool
        Its pages are taken as they stand.
    axes : str
        As the file names them.
    shape : tuple of int
    image : OmeImage or None
        What OME metadata say of it.
    notes : tuple of str
        What of the metadata is not believed.
    evidence : str
    of : int
        How many series there are to choose from.
    """

    number: int
    plain: bool
    axes: str
    shape: tuple[int, ...]
    image: OmeImage | None = None
    notes: tuple[str, ...] = ()
    evidence: str = ""
    of: int = 1


def chosen_series(
    file: Path, tiff: tifffile.TiffFile, logged: Sequence[str], scene: str | None
) -> TiffSeries:
    """The image to read of a TIFF.

    Parameters
    ----------
    file : Path
    tiff : tifffile.TiffFile
        Opened.
    logged : sequence of str
        Messages of tifffile so far; it goes on growing.
    scene : str or None
        Number or name of the one to take.

    Raises
    ------
    ReadError
        There are several and none is chosen, or there is none of that name; or pixels are not square.
    """
    images, fault = _ome(file, tiff)
    fault = fault or _series_fault(tiff, logged)
    if fault:
        return _plain(file, tiff, images, f"its {_kind(tiff)} metadata cannot be used ({fault})", scene)
    series = tiff.series
    if len(series) > 1 and scene is None and _one_by_one(series):
        found = _plain(file, tiff, (), "", scene)
        return replace(found, evidence=f"its {found.shape[0]} pages were written one by one: one stack")
    number = _scene(file, series, [image.name for image in images], scene)
    if fault := _page_fault(tiff, series[number]):
        return _plain(file, tiff, images, fault, scene)
    image = images[number] if len(images) == len(series) else None
    notes: tuple[str, ...] = ()
    if images and image is None:
        notes = (
            f"its OME metadata describe {len(images)} images, it holds {len(series)}: scale and names of "
            "channels are not believed; pass --pixel-size, --frame-interval and --channels",
        )
    return TiffSeries(number, False, series[number].axes, series[number].shape, image, notes, of=len(series))


def _ome(file: Path, tiff: tifffile.TiffFile) -> tuple[tuple[OmeImage, ...], str]:
    """What OME metadata say, and why they cannot be used."""
    if not (tiff.is_ome and tiff.ome_metadata):
        return (), ""
    try:
        images = ome_images(file, tiff.ome_metadata)
    except OmeError as error:
        return (), str(error)
    page: Any = tiff.pages.first
    planes = max(image.planes for image in images)
    if planes > _MOST_PLANES:
        return (), f"they claim {planes} planes, the file has {len(tiff.pages)} pages"
    if not any(
        (image.sizes["X"], image.sizes["Y"]) == (page.imagewidth, page.imagelength) for image in images
    ):
        sizes = images[0].sizes
        said, there = f"{sizes['X']} × {sizes['Y']}", f"{page.imagewidth} × {page.imagelength}"
        return (), f"they claim images of {said} pixels, its pages have {there}"
    return images, ""


def _kind(tiff: tifffile.TiffFile) -> str:
    return next((name for kind, name in _NAMES.items() if getattr(tiff, f"is_{kind}")), "own")


def _series_fault(tiff: tifffile.TiffFile, logged: Sequence[str]) -> str:
    """Why tifffile makes no image of what the metadata say; empty if it does."""
    before = len(logged)
    try:
        kinds = {series.kind for series in tiff.series}
    except Exception as error:  # noqa: BLE001  whatever broken metadata raise, the pixels are there
        return " ".join(str(error).split())[:200] or type(error).__name__
    if any("failed to reshape" in message for message in logged[before:]):
        return "they do not fit its pages"
    wanted = next((kind for kind in _NAMES if getattr(tiff, f"is_{kind}")), None)
    if wanted is None or wanted in kinds or not kinds <= set(_OWN_LAYOUT) or "imagej" in kinds:
        return ""
    return "; ".join(logged[before:])[:200] or "they do not fit its pages"


def _one_by_one(series: Sequence[Any]) -> bool:
    """Whether images look like pages of one stack that a program appended one after the other."""
    first = series[0]
    return all((one.shape, one.dtype, one.kind) == (first.shape, first.dtype, "shaped") for one in series)


def _page_fault(tiff: tifffile.TiffFile, series: Any) -> str:
    """How a series contradicts the pages of the file; empty if it does not."""
    if series.kind not in _NAMES:
        return ""
    name, page = _NAMES[series.kind], series.keyframe
    planes = math.prod(series.shape) // max(math.prod(page.shape), 1)
    there = len(tiff.pages)
    if series.is_multifile or len(tiff.series) > 1 or there == planes:
        return ""
    if there > planes and _alike_pages(tiff, planes):
        return f"its {name} metadata claim {planes} planes, it has {there} pages"
    offset = series.dataoffset
    held = there == 1 if offset is None else offset + planes * page.nbytes <= tiff.filehandle.size
    if series.kind != "ome" and there < planes and not held and there > 1:
        return f"its {name} metadata claim {planes} planes, it has {there} pages"
    return ""


def _alike_pages(tiff: tifffile.TiffFile, extra: int) -> bool:
    """Whether the first page that no image uses looks like those that are used."""
    first: Any = tiff.pages.first
    page: Any = tiff.pages.get(extra)
    return bool(page.shape == first.shape and page.dtype == first.dtype and not page.is_reduced)


def _plain(
    file: Path, tiff: tifffile.TiffFile, images: Sequence[OmeImage], fault: str, scene: str | None
) -> TiffSeries:
    with tiff_opened(file, plain=True) as pages:
        number = _scene(file, pages.series, (), scene)
        series = pages.series[number]
        axes, shape = series.axes, series.shape
    found = TiffSeries(number, True, axes, shape)
    image = images[0] if len(images) == 1 and len(shape) == 3 else None
    if image is not None and image.planes == shape[0] and not image.placed:
        order = f"{image.order}YX"
        return replace(
            found, axes=order, shape=(*(image.sizes[axis] for axis in image.order), *shape[1:]), image=image
        )
    if not fault:
        return found
    unknown = tiff.is_ome and image is None
    known = (
        "; scale and names are unknown: pass --pixel-size, --frame-interval and --channels" if unknown else ""
    )
    there = math.prod(shape[:-2])
    note = f"{fault}: its {there} pages are taken as they stand; if their order is wrong, pass --axes{known}"
    return replace(found, image=image, notes=(note,))


def _scene(file: Path, series: Sequence[Any], names: Sequence[str], scene: str | None) -> int:
    if not series:
        raise ReadError(f"{file} holds no image: copy it again")
    names = list(names) if len(names) == len(series) else [one.name for one in series]
    if len(series) == 1:  # a scene is chosen in another file then, as that of the signal
        return 0
    if scene is not None and (found := place_of(scene, names)) is not None:
        return found
    there = ", ".join(
        f"{place} ({name + ': ' if name else ''}{' × '.join(map(str, one.shape))})"
        for place, (one, name) in enumerate(zip(series, names, strict=True))
    )
    if scene is None:
        raise ReadError(
            f"{file} holds {len(series)} separate images: choose one with --scene, of {there}; or save all "
            "as one stack"
        )
    raise ReadError(f"{file} has no scene {scene!r}: pass --scene with one of {there}")
