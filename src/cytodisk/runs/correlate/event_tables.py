"""Events of the edge of one cell and the signal around them, as tables."""

from __future__ import annotations

import numpy as np
import pandas as pd
import xarray as xr

from cytodisk.analysis.correlation.prepared_series import prepare_series
from cytodisk.analysis.event_average import average_around
from cytodisk.analysis.events import KINDS, edge_events
from cytodisk.runs.correlate.correlate_parameters import CorrelateParameters


def event_tables(
    activity: xr.Dataset, signal: xr.DataArray, velocity: str, reach: int, settings: CorrelateParameters
) -> dict[str, pd.DataFrame]:
    """Events of protrusion and retraction, and the signal averaged around their onsets.

    Parameters
    ----------
    activity : Dataset
        Of one cell of a study, with its whole edge: patches of events are those of all sectors.
    signal : DataArray with dims (time, layer, sector)
        Signal of the same frames; its sectors may be some of them.
    velocity : str
        Which of its velocities; areas are those of the lab, whose outlines they compare.
    reach : int
        Frames before and after an onset.
    settings : CorrelateParameters
        The signal is detrended by them.

    Returns
    -------
    dict of str to DataFrame
        events and event_averages.

    Raises
    ------
    ParameterError
        There are too few frames to tell noise from motion.
    """
    counted = velocity == "velocity"  # areas are those between outlines in the lab
    won, lost = (activity[name].load() if counted else None for name in ("protruded_area", "retracted_area"))
    events = edge_events(activity[velocity].load(), protruded_area=won, retracted_area=lost)
    attrs = events.attrs
    events = events[events["sector"].isin(signal["sector"].to_numpy())].reset_index(drop=True)
    events.attrs = attrs | {"sectors": signal.sizes["sector"]}
    prepared = signal.copy(
        data=prepare_series(signal, detrend=settings.detrend, detrend_frames=settings.detrend_frames)
    )
    averages = [
        average_around(
            prepared, events, before=reach, after=reach, kind=kind, normalise="mean", seed=settings.seed
        )
        .to_dataframe(dim_order=["layer", "delay"])
        .reset_index()
        .assign(kind=kind)
        for kind in KINDS
    ]
    table = pd.concat(averages, ignore_index=True)
    names = ("kind", "layer", "delay", "delay_s", "mean", "lower", "upper", "n", "n_patches")
    table = table.reindex(columns=list(names))
    unit = str(signal.attrs.get("units", "a.u."))
    units = {"delay": "frame", "delay_s": "s"} | dict.fromkeys(("mean", "lower", "upper"), unit)
    table["delay_s"] = table["delay_s"].astype(np.float64)
    table.attrs = {"units": {name: units.get(name, "") for name in names}}
    return {"events": events, "event_averages": table}
