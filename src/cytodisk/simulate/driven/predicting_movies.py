"""Movies of a cell whose channels predict the velocity of its edge, or do not."""

from typing import Any

import numpy as np
import xarray as xr

from cytodisk.checks import one_of, whole_number
from cytodisk.simulate.driven.driven_cell_parameters import PredictingMovieParameters
from cytodisk.simulate.driven.driven_movies import ChannelSeries, DrivenMovie, driven_movie, resting_edge
from cytodisk.simulate.predicting.predicting_parameters import WhoPredictsParameters
from cytodisk.simulate.predicting.predicting_series import (
    PREDICTING_KINDS,
    PredictingKind,
    predicting_series,
)
from cytodisk.taking import takes

_INSIDE = 2**40  # from a movie's seed to that of the series inside, beyond all that count up


@takes(PredictingMovieParameters)
def predicting_movie(kind: PredictingKind = "white", seed: int = 0, **settings: Any) -> DrivenMovie:
    """A movie of one cell whose channel "source" predicts the velocity of its edge, or does not.

    `predicting_series` makes the series: its target pushes the edge in and out, its source is the brightness
    of channel "source" along the edge, and its driver, where there is one, that of channel "driver". Deeper
    than `depth_px` both channels follow series of their own, which know nothing of the edge.

    Parameters
    ----------
    kind : str
        One of `PREDICTING_KINDS`.
    seed : int
        At least 0; the same arguments give the same movie.
    **settings
        See `PredictingMovieParameters`.

    Returns
    -------
    DrivenMovie
        `series` has "velocity" and one for each channel; `truth` is that of `predicting_series`.

    Raises
    ------
    ParameterError
        As for `predicting_series`, or the edge comes too close to the cell's centre.

    See Also
    --------
    predicting_series : The series without a cell.
    wave_movie : A cell along whose edge a wave runs.

    Notes
    -----
    An edge that nothing pushes goes back to where it rests. So a part of its velocity is told by its own
    past, which changes nothing of what the source adds. What windows measure has noise: the gain that is
    found is somewhat smaller than that of the series.

    Examples
    --------
    >>> import cytodisk as cd
    >>> cell = cd.simulate.predicting_movie(frames=3, radius_px=15.0, coupling="common driver")
    >>> cell.signal.channel.values.tolist(), cell.truth["coupling"]
    (['source', 'driver'], 'common driver')
    """
    kind, seed = one_of("kind", kind, PREDICTING_KINDS), whole_number("seed", seed, 0)
    how = PredictingMovieParameters.of(**settings)
    size, asked = (how.frames, 1, how.sectors), how.part(WhoPredictsParameters)
    made = predicting_series(kind, seed, *size, **dict(asked))
    names = [name for name in ("source", "driver") if name in made]
    apart = asked.changed(coupling="common driver", strength=0.0, at_once=0.0)
    deep = predicting_series(kind, seed + _INSIDE, *size, **dict(apart))
    at_edge = {name: made[name].to_numpy().reshape(how.frames, how.sectors) for name in names}
    inside = {name: deep[name].to_numpy().reshape(how.frames, how.sectors) for name in names}
    edge = resting_edge(seed, how, made.target.to_numpy())
    channels = {name: ChannelSeries(at_edge[name][:, None], inside=inside[name]) for name in names}
    series = {"velocity": made.target.to_numpy()} | at_edge
    coords = {"frame": ("time", np.arange(how.frames)), "sector": np.arange(how.sectors)}
    truth = xr.Dataset({name: (("time", "sector"), one) for name, one in series.items()}, coords, made.attrs)
    return driven_movie(seed, how, edge, channels, truth)
