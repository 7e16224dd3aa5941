"""What a cell of a movie contributes to a population: one array, by the name of a summary."""

from __future__ import annotations

from collections.abc import Sequence

import xarray as xr

from cytodisk.errors import PopulationError
from cytodisk.runs.population.movies.correlation_summaries import at_peak, correlated_channels
from cytodisk.runs.population.movies.event_summaries import around_onsets
from cytodisk.runs.population.movies.prediction_summaries import gains
from cytodisk.runs.population.movies.summary_names import (
    MOVIE_SUMMARIES,
    OF_CORRELATIONS,
    OF_PREDICTIONS,
    OF_WAVES,
)
from cytodisk.runs.population.movies.time_summaries import mean_velocity, over_time
from cytodisk.runs.population.movies.wave_summaries import wave_order
from cytodisk.runs.used_series.chosen_of_study import channels_of
from cytodisk.store.study import Study

REACH = 10
"""Frames before and after an onset, for "around_events"."""


def movie_values(
    study: Study,
    cell: int,
    summary: str = "mean",
    *,
    channels: Sequence[str] | None = None,
    with_: str = "velocity",
    reach: int = REACH,
) -> xr.DataArray:
    """Sum a cell of a movie up, so that it can be compared with other cells.

    Sectors of a tracked movie follow the cell: a boundary point keeps its sector, and sector 0 is where the
    tracker took it from the first frame. A mean over time is therefore one in the tracked frame, not in that
    of the image.

    Parameters
    ----------
    study : Study
        Of a movie.
    cell : int
    summary : str
        "mean" or "sd": of each window over time; the sd holds drift and bleaching, too. "velocity": mean
        velocity of the edge by sector. "peak_correlation", "lag": correlation of each window with velocity at
        its peak, and the lag of the peak where p < 0.05, as `cytodisk correlate` found them. "around_events":
        the signal around onsets of protrusion, by layer and lag, less the same around any moment. "gain": how
        much the past of one signal predicts another beyond chance (nat), by layer, as `cytodisk predict`
        found it; "gain_score": the normal score of its p, to test against 0. "waves": order of waves by
        layer, as `cytodisk waves` found it.
    channels : sequence of str, optional
        Without it all of the study; for "peak_correlation" and "lag" all that were correlated. For "gain" and
        "gain_score" names of links, as "Rac1 → velocity", by default all that were tested. For "waves" one
        signal, by default velocity.
    with_ : str
        For "peak_correlation" and "lag": what the signal was correlated with.
    reach : int
        For "around_events": frames before and after the onset.

    Returns
    -------
    DataArray with dims (channel, layer, sector), or (channel, layer, lag)
        NaN for windows without a value, and for those that have one in fewer than half of the frames.
        `attrs["units"]` has the unit, `attrs["frames"]` the number of frames, where values are over time.
        Then the coordinate area has the mean area of each window. "velocity" has one layer, of compartment
        "edge". Values of "gain" and "waves" are the same in all sectors of a layer; of "waves"
        `attrs["numbers"]` has speed, period and others of the chosen layer.

    Raises
    ------
    NoValuesError
        This cell gives nothing; its message is the reason.
    PopulationError
        No cell of the study can: there is no such summary or channel, the study is not that of a movie, or
        the tables of its correlations, predictions or waves are missing (the message has the command to
        type).

    Notes
    -----
    A frame counts if it has a map (status "ok"); gaps are left out. The mean needs 5 frames, the velocity 5
    steps, the sd 10 frames, events 3 protrusions. The correlation at the peak is larger by chance in a short
    movie: compare movies of about the same length, or pool their curves with `cytodisk correlate BATCH`. A
    gain beyond chance has a mean of 0 where nothing predicts, whatever the length, but most are a little
    below it and few far above: test "gain_score" against 0, and compare "gain" between conditions.

    Examples
    --------
    >>> import tifffile
    >>> import cytodisk as cd
    >>> from cytodisk.runs.population.movie_values import movie_values
    >>> truth = cd.simulate.movie("growing", frames=6, radius_px=12.0)
    >>> tifffile.imwrite("masks.tif", truth.masks.astype("uint8"), metadata={"axes": "TYX"})
    >>> study = cd.run_movie("masks.tif", "out", layers=2, sectors=6)
    >>> movie_values(study, 0, "velocity").sizes
    Frozen({'channel': 1, 'layer': 1, 'sector': 6})
    """
    if summary not in MOVIE_SUMMARIES:
        raise PopulationError(f"summary must be one of {', '.join(MOVIE_SUMMARIES)}, got {summary!r}")
    if not study.is_movie:
        raise PopulationError(f"study {study.path} is not that of a movie: leave summary {summary!r} out")
    if summary == "velocity":
        return mean_velocity(study.activity(cell))
    if summary in OF_PREDICTIONS:
        return gains(study, cell, summary, channels)
    if summary in OF_WAVES:
        return wave_order(study, cell, channels)
    chosen = _channels(study, channels)
    if summary in OF_CORRELATIONS:
        if channels is None:
            chosen = correlated_channels(study, chosen, with_)
        return at_peak(study, cell, summary, chosen, with_)
    if summary == "around_events":
        return around_onsets(study.activity(cell), chosen, reach)
    return over_time(study.activity(cell), summary, chosen)


def _channels(study: Study, channels: Sequence[str] | None) -> list[str]:
    there = channels_of(study)
    if channels is None:
        return there
    if missing := [name for name in channels if name not in there]:
        raise PopulationError(
            f"channel {missing[0]!r} is not in study {study.path}: it has {', '.join(map(repr, there))}"
        )
    return list(channels)
