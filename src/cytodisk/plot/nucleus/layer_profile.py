"""A signal by layer, from the nucleus' centre to the membrane, as numbers."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr

from cytodisk.analysis.compartments.nuclear_profile import nuclear_profile
from cytodisk.arrays import FloatArray

_QUARTILES = (0.25, 0.75)


@dataclass(frozen=True, eq=False)
class LayerProfile:
    """What a profile shows, with layers in their order, from the membrane in.

    Attributes
    ----------
    channels : list of str
    values : ndarray of shape (C, L)
        Mean of each layer over its pixels, in a movie the mean over frames.
    low, high : ndarray of shape (C, L)
        Quartiles of the layer's sectors, each the mean of its frames.
    whole : ndarray of shape (C,)
        Mean of the cell.
    area, depth, distance : ndarray of shape (L,)
        Of each layer, as `nuclear_profile` gives them; distance is that to the nuclear outline.
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
    cytoplasm_layers: int
    units: dict[str, str]

    @classmethod
    def of(cls, data: xr.Dataset) -> LayerProfile:
        """The profile of what `sample` or `sample_movie` returned for cells with a nucleus.

        Raises
        ------
        WindowError
            There are no layers of a nucleus in it.
        ParameterError
            It is not a Dataset.
        """
        profile = nuclear_profile(data)
        sectors = data["mean"]
        if "time" in data.dims:
            profile, sectors = profile.mean("time", keep_attrs=True), sectors.mean("time")
        mean = _by_channel(profile["mean"])
        low, high = (_by_channel(sectors.quantile(share, "sector")) for share in _QUARTILES)
        area = profile["area"].to_numpy()
        known = np.isfinite(mean) * area
        return cls(
            channels=[str(name) for name in np.atleast_1d(data["channel"])]
            if "channel" in data
            else ["signal"],
            values=mean,
            low=low,
            high=high,
            whole=np.nansum(mean * area, axis=-1) / known.sum(axis=-1),
            area=area,
            depth=profile["depth"].to_numpy(),
            distance=profile["nucleus_distance"].to_numpy(),
            cytoplasm_layers=int((data["compartment"] != "nucleus").sum()),
            units={name: str(profile[name].attrs.get("units", "")) for name in ("mean", "depth")},
        )

    @property
    def layers(self) -> int:
        """Number of layers."""
        return len(self.area)

    @property
    def thickness(self) -> float:
        """How far the membrane is from the nuclear outline, on average."""
        return float(self.distance[0] + self.depth[0])

    @property
    def relative(self) -> LayerProfile:
        """The same with values as multiples of the mean of the cell."""
        of_cell = self.whole[:, None]
        parts = (self.values / of_cell, self.low / of_cell, self.high / of_cell)
        fields = self.__dict__ | dict(zip(("values", "low", "high"), parts, strict=True))
        return LayerProfile(**fields | {"units": self.units | {"mean": "1"}})


def _by_channel(values: xr.DataArray) -> FloatArray:
    """Values as (channel, layer), of one channel too."""
    table = values if "channel" in values.dims else values.expand_dims("channel")
    return np.asarray(table.transpose("channel", "layer"), dtype=np.float64)
