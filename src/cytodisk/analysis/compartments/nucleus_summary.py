"""`nucleus_summary`: the nucleus of a cell and the signals in and around it, in a few numbers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from cytodisk.analysis.compartments.channel_summary import NUMBERS, UNITS, channel_summary, without_summary
from cytodisk.analysis.compartments.nuclear_profile import check_nuclear, nuclear_layers
from cytodisk.analysis.compartments.nucleus_place import NOWHERE, direction_in_disk, nucleus_place
from cytodisk.checks import instance_of
from cytodisk.disk.disk_map import DiskMap
from cytodisk.errors import WindowError
from cytodisk.motion.disk_movie import DiskMovie
from cytodisk.scale import Scale

_OF_WINDOWS = ("mean", "sd", "n_pixels", "area")


def nucleus_summary(disk: DiskMap | DiskMovie, data: xr.Dataset | None = None) -> xr.Dataset:
    """Place of a cell's nucleus, and how signals are spread over nucleus and cytoplasm.

    Parameters
    ----------
    disk : DiskMap or DiskMovie
        Of a cell with its nucleus.
    data : Dataset, optional
        What `sample` says of windows on that map, or `sample_movie` of the movie. Without it there is the
        place of the nucleus alone.

    Returns
    -------
    Dataset with the dims channel and time, where they are there
        Of the nucleus: nucleus_area; nucleus_offset, the distance between its centroid and the cell's;
        nucleus_polarity, that distance over the radius of a disk of the cell's area; nucleus_direction, from
        its centroid to the cell's, in degrees from +x towards +y. Lengths are in µm, or in px without a
        scale.

        Of each channel: nucleus_mean and cytoplasm_mean; nucleus_to_cytoplasm, the one over the other;
        ratio_of_totals, the same of totals; perinuclear_share and peripheral_share, what the
        third of the cytoplasm's area at the nucleus, and that at the membrane, holds of the cytoplasm's
        total; signal_polarity, from 0 for a cytoplasm that is alike all around to 1 for one with all signal
        in one sector; signal_direction, where to, in degrees from nucleus_direction on: near 0 the signal
        is on the side away from the nucleus, near ±180 on the side of the nucleus. reason says why numbers
        are missing.

    Raises
    ------
    WindowError
        `data` has no layers of a nucleus, or is of other frames.
    ParameterError
        `disk` is no map or movie, or `data` no Dataset.

    See Also
    --------
    nuclear_profile : The signal by layer.

    Notes
    -----
    What gives such numbers without any biology:

    * Background. It adds the same to nucleus and cytoplasm, so it draws ratios to 1, shares to 1/3 and
      polarity to 0. Nothing is subtracted here: subtract the mean of a place without cells first.
    * Thickness. In a wide-field image the cell is thicker where the nucleus is, so that an even signal is
      brighter there. Compare with a channel that is known to be even.
    * An even cytoplasm has shares of 1/3, wherever the nucleus lies: thirds are of its area.
    * A nucleus out of the middle. A signal at the membrane alone has a polarity towards the side where the
      nucleus is close to the membrane, because the way from one to the other is short there.
    * Noise. The polarity of noise is above 0. The direction is NaN where the polarity is at most twice what
      the spread of pixels within windows gives, and the nucleus' own where its offset is below 1 px.

    A ratio or share is NaN where the mean that it is made of is 0 or below, as after too much background was
    subtracted. A window without a number counts as the mean of the others in its layer. Thirds are exact if 3
    divides the number of equal layers; else the border of a third cuts through a layer as if the signal was
    even in it. Shares are NaN where that layer holds more than 40 % of the cytoplasm.

    Examples
    --------
    >>> import cytodisk as cd
    >>> cell = cd.simulate.cell_with_nucleus("off centre", seed=1)
    >>> signal = cd.simulate.profile_signal(
    ...     cell.mask, cell.nucleus, lambda place: 100.0 + 0.0 * place, in_nucleus=250.0
    ... )
    >>> disk = cd.map_to_disk(cell.mask, nucleus=cell.nucleus, pixel_size_um=0.5)
    >>> windows = cd.polar_windows(layers=6, sectors=12, nucleus_layers=2).on(disk)
    >>> summary = cd.nucleus_summary(disk, cd.sample(windows, signal))
    >>> float(summary["nucleus_to_cytoplasm"].round(3)), float(summary["perinuclear_share"].round(3))
    (2.5, 0.333)
    >>> float(summary["nucleus_offset"].round(1)), summary["nucleus_offset"].attrs["units"]
    (10.7, 'µm')
    """
    instance_of("disk", disk, (DiskMap, DiskMovie), "a map with a nucleus, or a movie of such maps")
    if data is not None:
        check_nuclear(data)
    if isinstance(disk, DiskMap):
        maps: list[DiskMap | None] = [disk]
        faults = ["the map has no nucleus"]
    else:
        maps = [disk[frame] if disk.records[frame].has_map else None for frame in range(len(disk))]
        faults = [record.reason or "the map has no nucleus" for record in disk.records]
    by_frame = () if isinstance(disk, DiskMap) else ("time",)
    found = _places(maps, disk.scale, by_frame)
    if data is None:
        return found.assign_attrs(disk.scale.attrs)
    _check_frames(data, disk)
    return found.merge(_signals(maps, faults, data, by_frame)).assign_attrs(data.attrs)


def _check_frames(data: xr.Dataset, disk: DiskMap | DiskMovie) -> None:
    frames = None if isinstance(disk, DiskMap) else len(disk)
    if data.sizes.get("time") != frames:
        given = f"{data.sizes['time']} frames" if "time" in data.sizes else "one frame"
        raise WindowError(
            f"data is of {given}, disk of {'one' if frames is None else frames}: pass the map and "
            "what sample made of it, or the movie and what sample_movie did"
        )


def _places(maps: Sequence[DiskMap | None], scale: Scale, by_frame: tuple[str, ...]) -> xr.Dataset:
    places = [NOWHERE if disk is None else nucleus_place(disk) for disk in maps]
    columns = {
        "nucleus_area": (scale.area(np.array([place.area_px for place in places])), scale.area_unit),
        "nucleus_offset": (scale.length(np.array([place.offset_px for place in places])), scale.length_unit),
        "nucleus_polarity": (np.array([place.polarity for place in places]), "1"),
        "nucleus_direction": (np.array([place.direction for place in places]), "°"),
    }
    return xr.Dataset(
        {
            name: (by_frame, values if by_frame else values[0], {"units": unit})
            for name, (values, unit) in columns.items()
        }
    )


def _signals(
    maps: Sequence[DiskMap | None], faults: Sequence[str], data: xr.Dataset, by_frame: tuple[str, ...]
) -> xr.Dataset:
    """The numbers of each channel, by frame in a movie."""
    others = [dim for dim in data["mean"].dims if dim not in ("time", "layer", "sector")]
    dims = (*by_frame, *others)
    mean, sd, n_pixels, areas = (
        data[name].broadcast_like(data["mean"]).transpose(*dims, "layer", "sector").to_numpy()
        for name in _OF_WINDOWS
    )
    nuclear, towards = (
        nuclear_layers(data),
        [np.nan if disk is None else direction_in_disk(disk) for disk in maps],
    )
    shape = mean.shape[:-2]
    found: dict[str, Any] = {name: np.full(shape, np.nan) for name in NUMBERS}
    found["reason"] = np.full(shape, "", dtype=object)
    for at in np.ndindex(*shape):
        frame = at[0] if by_frame else 0
        disk = maps[frame]
        if disk is None or disk.nucleus is None:
            summary = without_summary(faults[frame])
        else:
            own = mean[at], sd[at], n_pixels[at], areas[at]
            summary = channel_summary(*own, nuclear, towards[frame])
        for name, value in summary._asdict().items():
            found[name][at] = value
    variables: dict[str, Any] = {name: (dims, found[name], {"units": UNITS[name]}) for name in NUMBERS}
    variables["reason"] = (dims, found["reason"].astype(str))
    coords = {name: coord for name, coord in data.coords.items() if set(coord.dims) <= set(dims)}
    return xr.Dataset(variables, coords)
