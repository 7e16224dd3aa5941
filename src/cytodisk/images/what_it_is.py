"""What the array of a mask file is: a mask, a stack of masks or label images; or what else it looks like."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, TypeAlias

import numpy as np

from cytodisk.errors import CytodiskError, MaskError, ReadError, as_data
from cytodisk.geometry.fragments import SeveralCells, without_others
from cytodisk.images.changed_frames import changed_file
from cytodisk.images.chosen_channels import filled_channels, with_empty_note
from cytodisk.images.evidence.classes import TwoClasses, may_be_classes, two_classes
from cytodisk.images.evidence.frame_labels import check_labels
from cytodisk.images.evidence.frame_sight import BACKGROUND_SHARE, FrameSight, see_frame
from cytodisk.images.evidence.picture_signs import fraction_words, picture_words
from cytodisk.images.file_axes import axis_words
from cytodisk.images.file_parameters import Fragments, Kind, KindParameters
from cytodisk.images.frame_file import FrameFile
from cytodisk.images.frame_pixels import FramePixels, frame_pixels
from cytodisk.images.label_boxes import cell_box
from cytodisk.images.short_lists import shortened

_NAMED = 8  # channels that a message names
_FEW_FRAMES = 2  # with fractions, and none without, are enough to see a picture

Reader: TypeAlias = Callable[[int], FramePixels]
Seen: TypeAlias = FrameSight | ReadError


@dataclass(frozen=True)
class MaskLook:
    """What one look at all frames of a mask file says.

    Attributes
    ----------
    kind : {"mask", "stack", "labels"}
    file : FrameFile
        To be read in the place of the one that was looked at: its values may be changed, such as numbered.
    labels : tuple of (tuple of int, or CytodiskError)
        For label images, the labels of each frame; the fault of one that cannot be used. Else empty.
    evidence : str
        Why it is of this kind, in words.
    fragments : {"refuse", "largest"}
        What to do with a mask of several pieces.
    """

    kind: Kind
    file: FrameFile
    labels: tuple[tuple[int, ...] | CytodiskError, ...] = ()
    evidence: str = ""
    fragments: Fragments = "refuse"

    def cells_in(self, number: int) -> int:
        """How many rows a frame gives: one a cell; one, too, where it holds none, or has a fault."""
        if self.kind != "labels" or isinstance(found := self.labels[number], CytodiskError):
            return 1
        return max(1, len(found))

    @property
    def words(self) -> str:
        """The evidence for its kind and its axes; empty where there is nothing to say."""
        return "; ".join(filter(None, [self.evidence, self.file.evidence]))


def look_at(file: FrameFile, how: KindParameters | None = None, read: Reader | None = None) -> MaskLook:
    """What a mask file holds; its frames are read once, unless the user says enough.

    Parameters
    ----------
    file : FrameFile
    how : KindParameters, optional
        What the user says of it. A kind of "auto" is decided by its values: labels if any readable frame
        holds two beside 0; else one mask or a stack.
    read : callable, optional
        Opens a frame in the place of `frame_pixels`, such as to keep what was read.

    Returns
    -------
    MaskLook

    Raises
    ------
    MaskError
        The file has channels, is not what the user says, or looks like something else: a picture,
        probabilities, an inverted mask, or time on its last axis.
    ReadError
        For "auto", no frame can be read.
    """
    how = KindParameters() if how is None else how
    _check_shape(file, how)
    if how.kind in ("mask", "stack"):
        if file.doubt:
            raise MaskError(file.doubt)
        look = MaskLook(how.kind, file, evidence="as given")
    else:
        look = _decided(file, how.kind, read or partial(frame_pixels, file))
    return replace(_numbered(look) if how.label else look, fragments=how.fragments)


def _check_shape(file: FrameFile, how: KindParameters) -> None:
    if "C" in file.axes:
        axes = file.axes.replace("C", "T")
        may_be_frames = file.unnamed and "T" not in file.axes
        frames = f"; or if they are frames, pass --axes {axes}" if may_be_frames else ""
        fractions = file.dtype.kind == "f"
        probabilities = "; of probabilities, export the Simple Segmentation instead" if fractions else ""
        held = next(iter(filled_channels(file)), 0)
        raise MaskError(
            f"{file.path} has {len(file.channels)} channels ({shortened(file.channels, _NAMED)}): "
            f"a mask has one value a pixel; pass the channel that holds it, as --mask-channel {held}, or "
            f"save the mask alone, not as a colour picture{frames}{probabilities}"
        )
    if how.kind == "mask" and file.n_frames > 1:
        raise MaskError(
            f"{file.path} is a stack of {file.n_frames} frames where one image is needed: "
            "save the frame alone, or pass kind='stack' (--kind stack)"
        )
    if how.kind == "labels" and how.label:
        raise MaskError("labels have numbers already: leave out --label, or --kind labels")


def _decided(file: FrameFile, kind: Kind, read: Reader) -> MaskLook:
    seen = _seen(file, read, pictures_refused=kind == "auto")
    usable = [sight for sight in seen if isinstance(sight, FrameSight)]
    classes = two_classes(usable) if kind == "auto" else None
    if classes is not None:
        return _of_classes(file, classes)
    if kind == "auto":
        if not usable:
            raise next(sight for sight in reversed(seen) if isinstance(sight, ReadError))
        _refuse_axes(file, seen)
        _refuse_background(file, usable)
    elif file.doubt:
        raise MaskError(file.doubt)
    if usable and not any(len(sight.cells) for sight in usable):
        file = with_empty_note(file)
    several = next((sight for sight in usable if len(sight.cells) > 1), None)
    if file.dtype.kind == "f" and all(sight.is_whole for sight in usable):
        greatest = max((float(sight.values.max()) for sight in usable), default=0.0)
        if kind == "labels" or greatest > 1:
            file = changed_file(file, "whole")
    if kind == "labels" or several is not None:
        labels = tuple(_labels_of(sight, file.dtype) for sight in seen)
        return MaskLook("labels", file, labels, _several_words(several))
    found: Kind = "stack" if file.n_frames > 1 else "mask"
    return MaskLook(found, file, evidence="no frame holds two values beside 0" if found == "stack" else "")


def _of_classes(file: FrameFile, classes: TwoClasses | str) -> MaskLook:
    """A file of two classes as masks, where it is plain which one is the background."""
    if isinstance(classes, str):
        raise MaskError(f"{file.path} {classes}")
    if file.doubt:
        raise MaskError(file.doubt)
    masks = changed_file(file, "class 1" if classes.cells == 1 else "class 2")
    masks = replace(masks, notes=(*masks.notes, classes.words))
    return MaskLook("stack" if file.n_frames > 1 else "mask", masks, evidence=classes.words)


def _several_words(sight: FrameSight | None) -> str:
    return "as given" if sight is None else f"frame {sight.number} holds {len(sight.cells)} values beside 0"


def _seen(file: FrameFile, read: Reader, pictures_refused: bool) -> list[Seen]:
    """What is seen of each frame; a picture is refused as soon as that is plain.

    One frame with fractions in a movie of masks is that frame's fault alone; without a whole one beside it,
    or among labels, it is the file's.
    """
    seen: list[Seen] = []
    looked = whole = False
    fractions = ""
    for number in range(file.n_frames):
        try:
            frame = read(number)
            sight = see_frame(frame, number)
        except ReadError as fault:
            seen.append(as_data(fault))
            continue
        seen.append(sight)
        if not pictures_refused or not len(sight.cells):
            continue
        whole |= sight.is_whole
        fractions = fractions or fraction_words(sight)
        words = ""
        if sight.is_whole and len(sight.cells) > 1 and not looked and not may_be_classes(sight):
            looked, words = True, picture_words(frame, sight)
        if words := words or (fractions if looked or (not whole and number >= _FEW_FRAMES) else ""):
            raise MaskError(f"{file.path} {words}")
    if fractions and not whole:
        raise MaskError(f"{file.path} {fractions}")
    return seen


def _labels_of(sight: Seen, dtype: np.dtype[Any]) -> tuple[int, ...] | CytodiskError:
    if isinstance(sight, ReadError):
        return sight
    try:
        check_labels(dtype, sight.values, sight.number)
    except MaskError as fault:
        return as_data(fault)
    return tuple(int(label) for label in sight.cells.tolist())


def _refuse_axes(file: FrameFile, seen: Sequence[Seen]) -> None:
    """Refuse a guess of axes that the shape or the pixels speak against.

    Through time the cell is there from the first frame to the last, and does not reach both ends of rows or
    columns; along Y and X it is the other way round.
    """
    if file.said_by != "nobody" or file.n_frames < 2:
        return
    usable = [sight for sight in seen if isinstance(sight, FrameSight)]
    ends = [sight for sight in (seen[0], seen[-1]) if isinstance(sight, FrameSight)]
    rows, columns = (
        [any(sight.held[side] for sight in usable) for side in sides] for sides in ((0, 1), (2, 3))
    )
    if len(ends) == 2 and not any(len(sight.cells) for sight in ends):
        for letters, held in (("YXT", columns), ("YTX", rows)):
            other = rows if held is columns else columns
            if all(held) and not any(other):
                raise MaskError(axis_words(file.path, file.axes, file.shape, letters, "where the cell lies"))
    elif len(ends) == 2 and all(len(sight.cells) for sight in ends) and not any(columns):
        return  # as it is through time, whatever the shape looks like
    if file.doubt:
        raise MaskError(file.doubt)


def _refuse_background(file: FrameFile, usable: Sequence[FrameSight]) -> None:
    """Refuse a file that has the background marked in all of its frames."""
    held = [sight for sight in usable if len(sight.cells) and len(sight.values) > 1]
    around = [sight.around for sight in held]
    if not held or any(value == 0 or share < BACKGROUND_SHARE for value, share in around):
        return
    value, share = min(around, key=lambda pair: pair[1])
    what = "each frame" if file.n_frames > 1 else "the image"
    one = "stack" if file.n_frames > 1 else "mask"
    kind = "labels" if any(len(sight.cells) > 1 for sight in held) else one
    classes = any(may_be_classes(sight) for sight in held)
    export = " (of classes of ilastik, export Object Identities)" if classes else ""
    raise MaskError(
        f"{file.path} looks inverted, with the background marked as a cell: {share:.0%} of the border of "
        f"{what} has the value {value:g}. Invert it (in Fiji: Edit > Invert), or set the background to "
        f"0{export}; if the cell does fill the image, pass kind={kind!r} (--kind {kind})"
    )


def refuse_several(look: MaskLook, read: Reader | None = None) -> None:
    """Raise SeveralCells for a file of masks of one cell each, if all of them hold several.

    Where some do, each of those costs its own row.

    Parameters
    ----------
    look : MaskLook
    read : callable, optional
        Opens a frame in the place of `frame_pixels`.
    """
    if look.kind == "labels" or look.fragments == "largest":
        return
    fault: SeveralCells | None = None
    for number in range(look.file.n_frames):
        try:
            frame = (read or partial(frame_pixels, look.file))(number)
            box, _ = cell_box(frame.strips())
            if box is None:
                continue
            found = without_others(frame.cut(*box)[0], look.fragments, None)
        except ReadError:  # whoever reads the frame for good tells of it
            continue
        if not isinstance(found, SeveralCells):
            return
        fault = fault or found
    if fault is not None:
        where = "in each frame " if look.file.n_frames > 1 else ""
        raise SeveralCells(f"{look.file.path}: {where}{fault}")


def _numbered(look: MaskLook) -> MaskLook:
    """The pieces of masks as labels."""
    if look.kind == "labels":
        raise MaskError(
            f"{look.file.path} holds labels already ({look.evidence}): leave out --label; "
            "or if its values are no labels, threshold it"
        )
    file = changed_file(look.file, "numbered")
    labels = tuple(_numbers(file, number) for number in range(file.n_frames))
    return MaskLook("labels", file, labels, "pieces of the mask, numbered")


def _numbers(file: FrameFile, number: int) -> tuple[int, ...] | CytodiskError:
    try:
        return tuple(range(1, int(file.frame(number).max(initial=0)) + 1))
    except ReadError as fault:
        return as_data(fault)
