"""A signal by layer, from the nucleus' centre to the membrane, as numbers."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr

from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError
from cytodisk.plot.layer_looks import cytoplasm_layers_of

_NEEDED = ("mean", "n_pixels", "area", "depth", "nucleus_distance")
_QUARTILES = (0.25, 0.75)


@dataclass(frozen=True, eq=False)
class LayerProfile:
    """What a profile shows, with layers in their order, from the membrane in.

    Attributes
    ----------
    channels : list of str
    values : ndarray of shape (C, L)
        Mean of each layer over its pixels and all frames.
    low, high : ndarray of shape (C, L)
        Quartiles of the layer's sectors, each the mean of its frames.
    whole : ndarray of shape (C,)
        Mean of the cell.
    area, depth, distance : ndarray of shape (L,)
        Area of each layer; medians over its windows of their distance to the membrane, and to the nuclear
        outline.
    thickness : float
        Median over sectors of how far the membrane is from the nuclear outline.
    cytoplasm_layers : int
    units : dict of str to str
        Of "mean" and "depth".
    """

    channels: list[str]
    values: FloatArray
    low: FloatArray
    high: FloatArray
    whole: FloatArray
    area: FloatArray
    depth: FloatArray
    distance: FloatArray
    thickness: float
    cytoplasm_layers: int
    units: dict[str, str]

    @classmethod
    def of(cls, data: xr.Dataset) -> LayerProfile:
        """The profile of what `sample` or `sample_movie` returned for cells with a nucleus.

        Raises
        ------
        ParameterError
            It is no such dataset.
        """
        data = _checked(data)
        flat = data if "channel" in data.dims else data.expand_dims("channel")
        names = [str(name) for name in flat["channel"].to_numpy()] if "channel" in flat.coords else ["signal"]
        times = [name for name in ("time",) if name in flat.dims]
        pixels = flat["n_pixels"].where(flat["mean"].notnull())
        by_layer = (flat["mean"] * pixels).sum([*times, "sector"]) / pixels.sum([*times, "sector"])
        cell = (flat["mean"] * pixels).sum([*times, "layer", "sector"]) / pixels.sum(
            [*times, "layer", "sector"]
        )
        sectors = flat["mean"].mean(times)
        low, high = (sectors.quantile(share, "sector") for share in _QUARTILES)
        cytoplasm = cytoplasm_layers_of(data) or 0
        over = [*times, "sector"]
        reach = (data["depth"] + data["nucleus_distance"]).isel(layer=slice(0, cytoplasm))
        return cls(
            channels=names,
            values=_table(by_layer),
            low=_table(low),
            high=_table(high),
            whole=np.atleast_1d(cell.to_numpy()),
            area=np.asarray(data["area"].sum("sector").mean(times)),
            depth=np.asarray(data["depth"].median(over)),
            distance=np.asarray(data["nucleus_distance"].median(over)),
            thickness=float(reach.isel(layer=0).median()),
            cytoplasm_layers=cytoplasm,
            units={name: str(data[name].attrs.get("units", "")) for name in ("mean", "depth")},
        )

    @property
    def layers(self) -> int:
        """Number of layers."""
        return len(self.area)

    @property
    def relative(self) -> LayerProfile:
        """The same with values as multiples of the mean of the cell."""
        of_cell = self.whole[:, None]
        parts = (self.values / of_cell, self.low / of_cell, self.high / of_cell)
        fields = self.__dict__ | dict(zip(("values", "low", "high"), parts, strict=True))
        return LayerProfile(**fields | {"units": self.units | {"mean": "1"}})


def _checked(data: xr.Dataset) -> xr.Dataset:
    remedy = "pass what sample or sample_movie returned for maps with a nucleus"
    if not isinstance(data, xr.Dataset):
        raise ParameterError(f"data must be a Dataset, got {type(data).__name__}: {remedy}")
    missing = [name for name in (*_NEEDED, "compartment") if name not in data.variables]
    if missing:
        raise ParameterError(f"data lacks {', '.join(missing)}: {remedy}")
    return data


def _table(values: xr.DataArray) -> FloatArray:
    return np.asarray(values.transpose("channel", "layer"), dtype=np.float64)
