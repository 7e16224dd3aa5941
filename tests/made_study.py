"""Studies of movies whose series are made, not measured: no mask is mapped, no image is read."""

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr

from cytodisk.simulate.predicting.predicting_series import predicting_series
from cytodisk.store.provenance_file import write_json
from cytodisk.store.study import Study

INTERVAL_S = 5.0


@dataclass(frozen=True)
class MadeStudy(Study):
    """A study with made activity; everything that is written about it is real."""

    made: dict[int, xr.Dataset] = field(default_factory=dict)

    def activity(self, cell: int = 0) -> xr.Dataset:
        return self.made[cell]


def made_study(folder: Path, made: dict[int, xr.Dataset]) -> MadeStudy:
    """The study of some cells, whose folder holds a provenance alone."""
    one = next(iter(made.values()))
    rows = [
        {"cell": cell, "frame": frame, "status": "ok", "reason": "", "restarted": ""}
        for cell, activity in made.items()
        for frame in activity["frame"].to_numpy().tolist()
    ]
    parameters = {"layers": one.sizes["layer"], "sectors": one.sizes["sector"]}
    provenance = {
        "fingerprint": {},
        "files": {},
        "run": "movie",
        "status": "complete",
        "parameters": parameters,
        "frame_interval_s": INTERVAL_S,
        "pixel_size_um": 0.2,
        "length_unit": "µm",
        "velocity_unit": "µm/s",
    }
    folder.mkdir(parents=True, exist_ok=True)
    write_json(folder / "provenance.json", provenance)
    return MadeStudy(folder, pd.DataFrame(rows), provenance, made)


def made_activity(channels: dict[str, np.ndarray], velocity: np.ndarray) -> xr.Dataset:
    """Activity of a cell with channels (time, layer, sector) and velocity (time, sector)."""
    frames, layers, sectors = next(iter(channels.values())).shape
    mean = np.stack(list(channels.values()), axis=1)
    depth = np.broadcast_to(np.arange(layers)[:, None] + 0.5, (frames, layers, sectors))
    steps = {"velocity": velocity, "velocity_cell_frame": velocity}
    data = {name: (("time", "sector"), values.copy(), {"units": "µm/s"}) for name, values in steps.items()}
    coords = {
        "frame": ("time", np.arange(frames)),
        "time_s": ("time", INTERVAL_S * np.arange(frames)),
        "channel": list(channels),
        "layer": np.arange(layers),
        "sector": np.arange(sectors),
    }
    whole = {
        "mean": (("time", "channel", "layer", "sector"), mean, {"units": "a.u."}),
        "depth": (("time", "layer", "sector"), depth, {"units": "µm"}),
        **data,
    }
    attrs = {"cell": 0, "pixel_size_um": 0.2, "frame_interval_s": INTERVAL_S}
    found = xr.Dataset(whole, coords, attrs).set_xindex("frame")
    for name in steps:
        found[name][-1] = np.nan  # no step leads out of the last frame
    return found


def predicting_activity(seed: int, frames: int = 100, layers: int = 2, sectors: int = 8, **how) -> xr.Dataset:
    """Rac1, whose layer 0 predicts velocity, and RhoA, which has nothing to do with either."""
    series = predicting_series("white", seed, frames, layers, sectors, **how)
    noise = np.random.default_rng([seed, 7]).normal(size=series["source"].shape)
    channels = {"Rac1": 100.0 + 10.0 * series["source"].to_numpy(), "RhoA": 50.0 + noise}
    return made_activity(channels, series["target"].to_numpy())
