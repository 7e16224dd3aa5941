"""`nuclear_profile`: a signal by layer, on the way from the membrane to the nucleus and into it."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from cytodisk.analysis.compartments.layer_sums import area_mean, group_means, layer_shares
from cytodisk.arrays import FloatArray
from cytodisk.checks import instance_of
from cytodisk.errors import WindowError

_NEEDED = ("mean", "n_pixels", "area", "depth", "nucleus_distance")
_WHERE = ("depth", "nucleus_distance")


def nuclear_profile(data: xr.Dataset) -> xr.Dataset:
    """Mean of a signal by layer, from the membrane to the nucleus and into it.

    Parameters
    ----------
    data : Dataset with dims (layer, sector), and channel and time where they are there
        What `sample` or `sample_movie` says of windows with `nucleus_layers`.

    Returns
    -------
    Dataset with dims (layer,), and channel and time where they are there
        Over the sectors of each layer: mean of the signal, each window weighted by its pixels; sd of the
        windows' means, weighted alike; n_windows that have a number. Then area of the layer; share, the share
        of the compartment's area that lies outside the layer's middle (cytoplasm: 0 at the membrane, 1 at the
        nucleus; nucleus: 0 at its outline); depth, the distance to the membrane, and nucleus_distance, the
        distance to the nuclear outline from either side: medians of the windows, weighted by area. The
        coordinate compartment says which layers are in the nucleus. Lengths are in µm, or in px without a
        scale.

    Raises
    ------
    WindowError
        There are no layers of a nucleus in it.
    ParameterError
        It is not a Dataset.

    See Also
    --------
    nucleus_summary : Numbers for the cell as a whole.

    Notes
    -----
    Windows without a number (see `nan` of `sample`) are left out. The signal is taken as it is: background
    that was not subtracted adds the same to all layers. Light from above and below the focus blurs both
    borders: layers beside the nuclear outline hold some light of the other side, up to the width of the
    microscope's focus.

    Examples
    --------
    >>> import cytodisk as cd
    >>> cell = cd.simulate.cell_with_nucleus("centred")
    >>> signal = cd.simulate.profile_signal(
    ...     cell.mask, cell.nucleus, lambda share: 100 + 50 * share, along="share", in_nucleus=20.0
    ... )
    >>> grid = cd.polar_windows(layers=5, sectors=12, nucleus_layers=1)
    >>> windows = grid.on(cd.map_to_disk(cell.mask, nucleus=cell.nucleus))
    >>> profile = cd.nuclear_profile(cd.sample(windows, signal))
    >>> profile["mean"].round().to_numpy()  # 100 at the membrane, 150 at the nucleus, 20 in it
    array([105., 115., 125., 135., 145.,  20.])
    >>> profile["nucleus_distance"].round().to_numpy()  # in pixels: the image has no scale
    array([23., 19., 15., 10.,  4.,  4.])
    """
    check_nuclear(data)
    values = {name: _as_array(data, name) for name in _NEEDED}
    mean, n_pixels, area = values["mean"], values["n_pixels"], values["area"]
    found = group_means(*np.broadcast_arrays(mean, n_pixels))
    by_layer = area.sum(axis=-1)
    arrays: dict[str, FloatArray] = {"mean": found.mean, "sd": found.sd, "n_windows": found.number}
    arrays |= {"area": by_layer, "share": layer_shares(by_layer, nuclear_layers(data))}
    arrays |= {name: area_mean(values[name], area) for name in _WHERE}
    units = {name: data[name].attrs.get("units", "") for name in ("area", *_WHERE)}
    units |= {"mean": "a.u.", "sd": "a.u.", "n_windows": "1", "share": "1"}
    dims = {name: _dims(data["mean" if name in ("mean", "sd", "n_windows") else "area"]) for name in arrays}
    variables: dict[str, Any] = {
        name: (dims[name], array, {"units": units[name]}) for name, array in arrays.items()
    }
    coords = {name: coord for name, coord in data.coords.items() if "sector" not in coord.dims}
    return xr.Dataset(variables, coords, attrs=data.attrs)


def check_nuclear(data: Any) -> None:
    """Check that these are numbers of windows with layers of a nucleus.

    Raises
    ------
    WindowError
        There are no layers of a nucleus, or something is missing.
    ParameterError
        It is not a Dataset.
    """
    instance_of("data", data, xr.Dataset, "a Dataset, as sample(windows, signal) returns it")
    if "compartment" not in data.coords or not nuclear_layers(data).any():
        raise WindowError(
            "data has no layers of a nucleus: pass nucleus to map_to_disk and nucleus_layers to "
            "polar_windows, and sample again"
        )
    missing = [name for name in _NEEDED if name not in data]
    if missing:
        raise WindowError(f"data lacks {', '.join(missing)}: pass all that sample or sample_movie returns")


def nuclear_layers(data: xr.Dataset) -> Any:
    """Whether each layer is in the nucleus, shape (layers,)."""
    return np.asarray(data["compartment"].to_numpy() == "nucleus")


def _as_array(data: xr.Dataset, name: str) -> FloatArray:
    """Values with layer and sector last."""
    return np.asarray(data[name].transpose(..., "layer", "sector").to_numpy(), dtype=np.float64)


def _dims(variable: xr.DataArray) -> tuple[Any, ...]:
    return (*(dim for dim in variable.dims if dim not in ("layer", "sector")), "layer")
