"""`shape_features`: a row of numbers for the shape of each cell."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import pandas as pd
from scipy import ndimage

from cytodisk.analysis.shape.cell_shape import CellShape, crop_shape
from cytodisk.analysis.shape.curvature_features import CURVATURE, RESOLVED_PX
from cytodisk.analysis.shape.depth_features import DEPTH
from cytodisk.analysis.shape.distortion_features import DISTORTION
from cytodisk.analysis.shape.feature import Feature, FeatureGroup
from cytodisk.analysis.shape.form import FORM
from cytodisk.analysis.shape.fourier import FOURIER
from cytodisk.analysis.shape.moments import MOMENTS
from cytodisk.analysis.shape.size import SIZE
from cytodisk.analysis.shape.skeleton import SKELETON
from cytodisk.errors import CytodiskError, MaskError
from cytodisk.geometry.mask import FilledMask
from cytodisk.geometry.mask_parameters import HoleParameters, Holes
from cytodisk.scale import UNKNOWN, Scale
from cytodisk.taking import takes

GROUPS: tuple[FeatureGroup, ...] = (
    SIZE,
    FORM,
    MOMENTS,
    FOURIER,
    CURVATURE,
    DEPTH,
    SKELETON,
    DISTORTION,
)
FEATURES: tuple[Feature, ...] = tuple(feature for group in GROUPS for feature in group.features)
SCALE_FREE: tuple[str, ...] = tuple(feature.name for feature in FEATURES if feature.scale_free)
TOO_SMALL = "too small for curvature and roughness to be those of the shape"
_MOST_CHANNELS = 4


@takes(HoleParameters)
def shape_features(masks: Any, *, pixel_size_um: float | None = None, **settings: Any) -> pd.DataFrame:
    """Measure the shape of cells: size, form, moments, outline, curvature, depth, skeleton, harmonic map.

    Each mask is first reduced to its largest piece without holes (`clean_mask`). Features are those of the
    outline, whatever is in it; with `holes="exclude"` the area alone is that without the holes.

    Parameters
    ----------
    masks : array_like of shape (H, W) or (N, H, W), or sequence of arrays of shape (H, W)
        A label image (each whole number but 0 is a cell; a boolean image is one cell), a stack of masks of
        one cell each, or a list of such masks, which may differ in size.
    pixel_size_um : float, optional
        Micrometres a pixel; by default that of a DataArray's attrs, else lengths are in px.
    **settings
        See `HoleParameters`.

    Returns
    -------
    DataFrame
        A row a cell: "cell" (its running number), "frame" (its place in the stack or list), "label", "status"
        ("ok" or "refused"), "reason" (why there are no numbers), "notes" (what cleaning changed, what was
        measured in another way), "qc_flags" (what speaks against one whole cell, or that it is too small),
        "touches_border", then the features, NaN for a refused cell. `attrs["units"]` and
        `attrs["description"]` are dicts by column, `attrs["scale_free"]` is the list of features that refer
        to the disk of the same area.

    Raises
    ------
    MaskError
        `masks` is none of these, has its channels last, or is a label image that holds no cell.
    ParameterError
        The pixel size is not a positive number.

    See Also
    --------
    complexity_score : One number a cell, from plain to complex.

    Notes
    -----
    Scale-free features stay nearly the same when the same shape is drawn larger, if its equivalent diameter
    D = √(4 area / π) is 75 px or more. The outline is smoothed over 3 px at least, against the steps of the
    pixels, so that below 75 px curvature, tips and bays, and below 60 px roughness, depend on the
    resolution: a star of 10 px has few tips or none. A cell below 75 px has a word in "qc_flags". Shares of
    thin parts, small percentiles of depth and high harmonics drift too, less and less up to about 120 px.
    Compare small cells with those of their size.

    No feature depends on place, turn or mirror image, up to the pixels. A cell that touches the image border
    is measured as far as it is seen.

    References
    ----------
    u-Unwrap, appendix B, describes shapes by features of another package; these are our own.

    Examples
    --------
    >>> import cytodisk as cd
    >>> masks = [cd.simulate.disk(20), cd.simulate.ellipse((10, 40))]
    >>> features = cd.shape_features(masks, pixel_size_um=0.5)
    >>> features["circularity"].round(1).tolist()
    [1.0, 0.5]
    >>> features.attrs["units"]["area"]
    'µm²'
    """
    holes = HoleParameters.of(**settings).holes
    scale, rows = Scale.of(masks).given(pixel_size_um), []
    for cell, (frame, label, mask) in enumerate(_cells(masks)):
        rows.append({"cell": cell, "frame": frame, "label": label} | shape_row(mask, scale, holes))
    return feature_table(rows, scale)


def shape_row(mask: Any, scale: Scale = UNKNOWN, holes: Holes = "fill") -> dict[str, Any]:
    """Status, remarks and features of one cell.

    Parameters
    ----------
    mask : array_like of shape (H, W)
    scale : Scale
    holes : {"fill", "exclude", "error"}

    Returns
    -------
    dict
        By column of `shape_features`; without features if the cell cannot be measured.
    """
    row: dict[str, Any] = {"status": "ok", "reason": "", "notes": "", "qc_flags": "", "touches_border": False}
    try:
        found = FilledMask.of(mask).under(holes)
        report = found.report
        row |= {
            "notes": "; ".join(report.notes),
            "qc_flags": "; ".join(report.qc_flags),
            "touches_border": report.touches_border,
        }
        shape = crop_shape(found.filled)
        values: dict[str, float] = {}
        for group in GROUPS:
            values |= group.measure(shape)
        values["area"] = float(report.area_px)
        row["notes"] = "; ".join([*report.notes, *shape.notes])
        row["qc_flags"] = "; ".join([*report.qc_flags, *_flags_of_size(shape)])
    except CytodiskError as error:
        return row | {"status": "refused", "reason": str(error)}
    return row | {feature.name: _scaled(feature, values[feature.name], scale) for feature in FEATURES}


def _flags_of_size(shape: CellShape) -> list[str]:
    if shape.diameter >= RESOLVED_PX:
        return []
    return [f"{TOO_SMALL}: D = {shape.diameter:.3g} px, below {RESOLVED_PX:.0f} px"]


def split_qc_flags(qc_flags: pd.Series[str]) -> tuple[pd.Series[bool], pd.Series[str]]:
    """Which cells are too small for curvature and roughness, and the other QC flags of each.

    Parameters
    ----------
    qc_flags : Series of str
        The column of `shape_features`.

    Returns
    -------
    small : Series of bool
    others : Series of str
    """
    small = qc_flags.str.contains(TOO_SMALL, regex=False)
    return small, qc_flags.str.replace(f"(; )?{TOO_SMALL}.*", "", regex=True)  # it stands last


def feature_table(rows: Sequence[dict[str, Any]], scale: Scale) -> pd.DataFrame:
    """Rows of cells as a table, with its units and descriptions.

    Parameters
    ----------
    rows : sequence of dict
        Each as `shape_row` returns it, with columns of its own before.
    scale : Scale
        That the rows are in.

    Returns
    -------
    DataFrame
        See `shape_features`.
    """
    before = [
        name for name in (rows[0] if rows else {}) if name not in {feature.name for feature in FEATURES}
    ]
    names = [feature.name for feature in FEATURES]
    table = pd.DataFrame(list(rows), columns=[*before, *names])
    table[names] = table[names].astype(np.float64)
    unit = scale.length_unit
    table.attrs["units"] = {feature.name: feature.unit.replace("length", unit) for feature in FEATURES}
    table.attrs["scale_free"] = list(SCALE_FREE)
    table.attrs["description"] = {feature.name: feature.description for feature in FEATURES}
    return table


def _scaled(feature: Feature, value: float, scale: Scale) -> float:
    if feature.unit == "length":
        return scale.length(value)
    return scale.area(value) if feature.unit == "length²" else value


def _cells(masks: Any) -> Iterator[tuple[int, int, Any]]:
    """Frame, label and mask of each cell."""
    if isinstance(masks, list | tuple) and masks and np.ndim(masks[0]) == 2:
        yield from ((frame, 1, _boxed(mask)) for frame, mask in enumerate(masks))
        return
    array = _as_array(masks)
    if array.ndim == 3:
        _refuse_channels(array)
        yield from ((frame, 1, _boxed(mask)) for frame, mask in enumerate(array))
    elif array.ndim == 2 and np.issubdtype(array.dtype, np.integer):
        yield from ((0, label, mask) for label, mask in _labelled(array))
    elif array.ndim == 2:
        yield 0, 1, _boxed(array)
    else:
        raise MaskError(
            "masks must be a label image (H, W), a stack (N, H, W) or a list of masks, "
            f"got shape {array.shape}: pass one channel"
        )


def _as_array(masks: Any) -> np.ndarray[Any, Any]:
    try:
        return np.asarray(masks)
    except ValueError as error:  # such as images of different sizes with channels
        raise MaskError(
            f"masks must be a label image (H, W), a stack (N, H, W) or a list of masks (H, W): {error}"
        ) from error


def _refuse_channels(stack: np.ndarray[Any, Any]) -> None:
    """Raise MaskError for what looks like one image with channels: masks no wider than four pixels."""
    if stack.shape[2] <= _MOST_CHANNELS < stack.shape[0]:
        raise MaskError(
            f"masks must be a label image (H, W) or a stack (N, H, W), got shape {stack.shape}, which looks "
            "like an image with channels last: pass one channel, such as masks[..., 0]"
        )


def _boxed(mask: Any) -> Any:
    """What a mask holds, cropped to its box and a margin of a pixel where the image goes on."""
    array = np.asarray(mask)
    inside = array != 0
    if array.ndim != 2 or not inside.any():
        return mask
    box = ndimage.find_objects(inside.astype(np.uint8))[0]
    return array[_wider(box)]


def _wider(box: Any) -> Any:
    return tuple(slice(max(side.start - 1, 0), side.stop + 1) for side in box)


def _labelled(image: np.ndarray[Any, Any]) -> Iterator[tuple[int, Any]]:
    """Each label with its mask, cropped to its box and a margin of a pixel where the image goes on."""
    if image.min(initial=0) < 0:
        raise MaskError(f"masks has negative labels (down to {image.min()}): set what is no cell to 0")
    labels, places = np.unique(image, return_inverse=True)
    places = places.reshape(image.shape) + (1 if labels.size and labels[0] != 0 else 0)
    found = labels[labels != 0]
    if not found.size:
        raise MaskError(f"masks is a label image of shape {image.shape} that holds no cell")
    for place, (label, box) in enumerate(zip(found, ndimage.find_objects(places), strict=True), start=1):
        yield int(label), places[_wider(box)] == place
