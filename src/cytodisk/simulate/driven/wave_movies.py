"""Movies of a cell along whose edge, or through which, a wave runs with known speed."""

from typing import Any

import numpy as np
import xarray as xr

from cytodisk.checks import one_of, whole_number
from cytodisk.simulate.driven.driven_cell_parameters import WaveMovieParameters
from cytodisk.simulate.driven.driven_movies import (
    ChannelSeries,
    DrivenMovie,
    driven_movie,
    mean_length_um,
    resting_edge,
)
from cytodisk.simulate.waves.wave_parameters import RunningParameters
from cytodisk.simulate.waves.wave_series import WAVE_KINDS, WaveKind, wave_series
from cytodisk.taking import takes

_LAYER_PX = 3.0  # depth of a layer of the wave inside, far less than a wave is long
_PUSHES: dict[WaveKind, WaveKind] = {"spiral": "running", "inward": "standing", "outward": "standing"}
"""What pushes the edge where a wave runs through the inside."""


@takes(WaveMovieParameters)
def wave_movie(kind: WaveKind = "running", seed: int = 0, **settings: Any) -> DrivenMovie:
    """A movie of one cell whose edge and whose channel carry one wave of known speed.

    Parameters
    ----------
    kind : str
        One of `WAVE_KINDS`. Channel "wave" shows the wave at all depths: for "running", "standing" and "none"
        the same from the edge to the centre, for the other kinds on its way in or out. The edge moves with
        the wave as it is at depth 0: outwards while a crest is there. Of "none" the channel's noise and the
        edge's are apart.
    seed : int
        At least 0; the same arguments give the same movie.
    **settings
        See `WaveMovieParameters`. What pushes the edge, and the channel, have noise of their own.

    Returns
    -------
    DrivenMovie
        `series` has "velocity", what pushes the edge, and "wave", the channel at the edge. `truth` is that of
        `wave_series`, with the edge's true mean length in place of one that was given. An edge that goes back
        to rest by itself is a little ahead of what pushes it, by the same phase all around.

    Raises
    ------
    ParameterError
        As for `wave_series`, or the edge comes too close to the cell's centre.

    See Also
    --------
    wave_series : The series without a cell.
    predicting_movie : A cell whose channels predict its edge.

    Examples
    --------
    >>> import cytodisk as cd
    >>> cell = cd.simulate.wave_movie("running", frames=3, radius_px=15.0, mode=2, period_s=50.0)
    >>> cell.truth["speed"], bool(0.1 < cell.truth["speed_um_s"] < 0.2)
    (0.01, True)
    """
    kind, seed = one_of("kind", kind, WAVE_KINDS), whole_number("seed", seed, 0)
    how = WaveMovieParameters.of(**settings)
    depth_um = _LAYER_PX * how.pixel_size_um
    layers = int(np.ceil(how.radius_px / _LAYER_PX))
    asked = dict(how.part(RunningParameters)) | {"layer_depth_um": depth_um}
    inside = wave_series(kind, seed, how.frames, how.sectors, layers, **asked)
    pushes = wave_series(
        _PUSHES.get(kind, kind), seed, how.frames, how.sectors, **asked | {"mode": inside.attrs["mode"]}
    )
    edge = resting_edge(seed, how, pushes.to_numpy())
    length_um = mean_length_um(edge, how.pixel_size_um)
    truth = inside.attrs | {
        "edge_length_um": length_um,
        "speed_um_s": inside.attrs["speed"] * length_um,
    }
    series = xr.Dataset({"velocity": pushes, "wave": inside.isel(layer=0, drop=True)}, attrs=truth)
    channels = {"wave": ChannelSeries(inside.to_numpy(), _LAYER_PX)}
    return driven_movie(seed, how, edge, channels, series)
