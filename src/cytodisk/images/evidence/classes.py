"""Classes of pixels without a 0, as in ilastik's Simple Segmentation: which one is the background."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from cytodisk.images.evidence.frame_sight import BACKGROUND_SHARE, FrameSight

_MOST_CLASSES = 5
_EXPORT = "export Object Identities"


@dataclass(frozen=True)
class TwoClasses:
    """Cells and background of a file with the values 1 and 2.

    Attributes
    ----------
    background, cells : {1, 2}
    share : float
        Of the image's border that is background, at least.
    """

    background: int
    cells: int
    share: float

    @property
    def words(self) -> str:
        """What was decided, and why."""
        return (
            f"values 1 and 2 and no 0, as classes of ilastik: {self.background} is taken for the background, "
            f"as it has {self.share:.0%} of the image's border, and {self.cells} for the cells"
        )


def may_be_classes(sight: FrameSight) -> bool:
    """Whether a frame has the values 1, 2, … and no 0."""
    values = sight.values.tolist()
    return 1 < len(values) <= _MOST_CLASSES and values == list(range(1, len(values) + 1))


def two_classes(sights: Sequence[FrameSight]) -> TwoClasses | str | None:
    """Which of two classes is the background.

    Parameters
    ----------
    sights : sequence of FrameSight
        Of all frames.

    Returns
    -------
    TwoClasses, str or None
        What stands against a decision, in words that end with the remedy; None for a file without classes,
        or of several with a plain background.
    """
    values = sorted({value for sight in sights for value in sight.values.tolist()})
    if not any(may_be_classes(sight) for sight in sights) or 0 in values:
        return None
    around = [sight.around for sight in sights if len(sight.values) > 1]
    background, share = min(around, key=lambda pair: pair[1])
    if values != [1, 2] and share >= BACKGROUND_SHARE:
        return None  # which is refused as inverted, whatever the other values are
    if values != [1, 2]:
        shown = ", ".join(f"{value:g}" for value in values)
        return (
            f"holds the values {shown} and no 0, as classes of ilastik's Simple Segmentation: {_EXPORT}, or "
            "make a mask of the class of the cells; if each value is a cell, pass kind='labels' "
            "(--kind labels)"
        )
    if share < BACKGROUND_SHARE or any(value != background for value, _ in around):
        return (
            "holds the values 1 and 2 and no 0, as classes of ilastik's Simple Segmentation, and both lie at "
            f"the border of the image, so which one is the background is not plain: {_EXPORT}, or set the "
            "background to 0; if both are cells, pass kind='labels' (--kind labels)"
        )
    return TwoClasses(int(background), 3 - int(background), share)
