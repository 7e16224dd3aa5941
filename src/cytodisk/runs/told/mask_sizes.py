"""How large cells are, in words: a wrong scale shows here."""

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from cytodisk.number_words import rounded

if TYPE_CHECKING:
    from cytodisk.scale import Scale


def size_words(areas_px: Sequence[int], scale: "Scale") -> str:
    """How large cells are: a wrong scale shows here.

    Parameters
    ----------
    areas_px : sequence of int
        In square pixels.
    scale : Scale
    """
    median = float(np.median(areas_px))
    least, most = min(areas_px), max(areas_px)
    diameter = scale.length(2.0 * np.sqrt(median / np.pi))
    area = f"{median:.0f} px²"
    if scale.pixel_size_um is not None:
        area += f", {rounded(scale.area(median))} {scale.area_unit}"
    spread = f" (from {least} to {most} px²)" if len(areas_px) > 1 else ""
    of = "median area" if len(areas_px) > 1 else "area"
    return f"{of} {area}{spread}, as a circle of {rounded(diameter)} {scale.length_unit} across"


def scale_words(diameters: ArrayLike, scale: "Scale") -> Iterator[str]:
    """A line where the scale makes cells of a size that no cell has.

    Parameters
    ----------
    diameters : array-like of float
        Of the cells, in the units of `scale`.
    scale : Scale
    """
    from cytodisk.runs.qc_flags.input_flags import scale_doubt

    doubt = scale_doubt(diameters, scale)
    if doubt is not None:
        yield f"implausible scale: {doubt.words}. {doubt.advice}"
