"""Parameters that say how files of masks and images are read."""

from typing import Literal, TypeAlias

from pydantic import field_validator

from cytodisk.parameters import Parameters, parameter

Kind: TypeAlias = Literal["auto", "mask", "stack", "labels"]
Fragments: TypeAlias = Literal["refuse", "largest"]

AXES = "TCZYX"
_AXES_WORDS = "letters T (time), C (channel), Z, Y and X, one an axis, such as TYX"


def checked_axes(axes: str | None) -> str | None:
    """Axes in capital letters.

    Raises
    ------
    ValueError
        They are no axes of an image.
    """
    if axes is None:
        return None
    letters = axes.strip().upper()
    if not set(letters) <= set(AXES) or len(set(letters)) < len(letters) or not {"Y", "X"} <= set(letters):
        raise ValueError(f"must be {_AXES_WORDS}, each once, Y and X among them")
    return letters


class KindParameters(Parameters):
    """What a mask file holds."""

    kind: Kind = parameter(
        "auto",
        'What the mask file holds: "mask" is one cell, "stack" one cell a frame, "labels" one cell a label; '
        '"auto" looks at the values.',
    )
    axes: str | None = parameter(
        None,
        "Axes of the mask file, one letter each, such as TYX or YXT; overrules what the file says.",
        words=_AXES_WORDS,
    )
    label: bool = parameter(False, "Number the pieces of a mask: each is a cell.")
    fragments: Fragments = parameter(
        "refuse",
        'What to do with a mask whose second piece has a tenth of the largest or more: "refuse" it, as it '
        'holds several cells, or measure the "largest" piece. Smaller pieces are dropped.',
    )

    _axes = field_validator("axes")(checked_axes)


class SignalFileParameters(Parameters):
    """How the file of a signal is read."""

    signal_axes: str | None = parameter(
        None,
        "Axes of the signal's file, one letter each, such as TCYX; overrules what the file says.",
        words=_AXES_WORDS,
    )

    _signal_axes = field_validator("signal_axes")(checked_axes)


class MovieKindParameters(KindParameters):
    """What the mask file of a movie holds."""

    kind: Literal["auto", "stack", "labels"] = parameter(
        "auto",
        'What the mask file holds: "stack" is one cell through time, "labels" one cell a label; "auto" looks '
        "at the values.",
    )
    link: bool = parameter(
        False, "Labels differ from frame to frame: give overlapping cells one label through time."
    )
