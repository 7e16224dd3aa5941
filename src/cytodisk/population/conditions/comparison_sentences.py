"""What a comparison reached and found, in sentences."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pandas as pd
import xarray as xr

from cytodisk.population.conditions.comparison_warnings import sizes_words
from cytodisk.population.conditions.experiment_units import NO_VALUES, Units
from cytodisk.population.conditions.window_words import p_words, signed, windows_words, with_minus
from cytodisk.population.exchange.exchanges import Exchanges
from cytodisk.population.significance import LEVEL


def reach_words(exchanges: Exchanges, units: Units) -> str:
    """What this number of experiments can give at best.

    Parameters
    ----------
    exchanges : Exchanges
    units : Units

    Returns
    -------
    str
    """
    ways = f"all {exchanges.count}" if exchanges.all_ways else f"{exchanges.count - 1} random"
    words = (
        f"{sizes_words(units)} can give p = {exchanges.smallest_p:.2g} at best ({ways} exchanges of labels)"
    )
    if exchanges.smallest_p > LEVEL:
        return f"{words}: no difference can reach {LEVEL:g}."
    return f"{words.rstrip('.')}."


def valueless_words(units: Units) -> Iterator[str]:
    """How many cells are in no mean because they have no values.

    Parameters
    ----------
    units : Units

    Yields
    ------
    str
        Nothing where all cells have values.
    """
    table = units.table
    experiments = table[(table["used"] > 0) | (table["reason"] == NO_VALUES)]
    missing = int((experiments["cells"] - experiments["used"]).sum())
    if missing:
        yield (
            f"{missing} of {int(experiments['cells'].sum())} cells have no values, as `units` says by "
            "experiment: they are not in the test."
        )


def found_words(
    names: tuple[str, str],
    windows: xr.Dataset,
    clusters: pd.DataFrame,
    scalars: pd.DataFrame,
    method: str = "max-T",
) -> Iterator[str]:
    """What differs, in windows, clusters and scalars.

    Parameters
    ----------
    names : (str, str)
        Of the control and of the other condition.
    windows : Dataset with dims (channel, layer, last)
    clusters : DataFrame
    scalars : DataFrame
    method : str
        How p_fwer of windows is corrected.

    Yields
    ------
    str
    """
    against = f"{names[1]} against {names[0]}"
    for channel in windows["channel"].values:
        yield _of_windows(against, str(channel), windows.sel(channel=channel), clusters, method)
    if windows.sizes["channel"] > 1:
        yield f"The {windows.sizes['channel']} channels were tested and corrected together."
    tested = scalars[scalars["status"] == "ok"]
    found = tested[tested["p_fwer"] <= LEVEL].sort_values("p_fwer", kind="stable")
    if len(tested):
        rows = "; ".join(_scalar_words(row) for _, row in found.head(4).iterrows())
        more = f"; and {len(found) - 4} more" if len(found) > 4 else ""
        words = f"Scalars, {against}: {len(found)} of {len(tested)} differ ({method}, p ≤ {LEVEL:g})"
        yield f"{words}: {rows}{more}." if rows else f"{words}{_alone_words(tested)}."


def _of_windows(against: str, channel: str, windows: xr.Dataset, clusters: pd.DataFrame, method: str) -> str:
    p = windows["p_fwer"].values
    total = int(np.isfinite(p).sum())
    if not total:
        return f"{channel}, {against}: no window could be tested."
    different = p <= LEVEL
    what = "windows" if "sector" in windows.dims else "points of the curves"
    words = f"{channel}, {against}: {int(different.sum())} of {total} {what} differ"
    words += f" ({method}, p ≤ {LEVEL:g})"
    own = clusters[clusters["channel"] == channel]
    found = own[own["p"] <= LEVEL]
    if len(found):
        parts = [
            f"{windows_words(row['layers'], row['sectors'], str(windows['p_fwer'].dims[-1]))} "
            f"({signed(row['difference'])}{_unit(windows)}, {p_words(row['p'])})"
            for _, row in found.head(3).iterrows()
        ]
        more = f" and {len(found) - 3} more" if len(found) > 3 else ""
        return f"{words}; {'cluster' if len(found) == 1 else 'clusters'}: {'; '.join(parts)}{more}."
    if not different.any():
        best = np.unravel_index(int(np.nanargmax(np.abs(windows["score"].values))), p.shape)
        difference, low, high = (
            float(windows[name].values[best]) for name in ("difference", "difference_low", "difference_high")
        )
        words += f", none in a cluster; the strongest of them has {p_words(float(p[best]))}, "
        words += signed(difference)
        between = f" ({with_minus(low)} to {with_minus(high)})" if np.isfinite(low) else ""
        words += f"{between}{_unit(windows)}"
    return f"{words.rstrip('.')}."


def trend_words(
    windows: xr.Dataset, clusters: pd.DataFrame, scalars: pd.DataFrame, step: str
) -> Iterator[str]:
    """What has a trend over a dose: windows by channel with their clusters, and scalars.

    Parameters
    ----------
    windows : Dataset with dims (channel, layer, last)
    clusters : DataFrame
    scalars : DataFrame
    step : str
        What slopes are told by, as "step of the dose".

    Yields
    ------
    str
    """
    for channel in windows["channel"].values:
        own = windows.sel(channel=channel)
        known = np.isfinite(own["p_fwer"].values)
        count = int((own["p_fwer"].values[known] <= LEVEL).sum())
        words = f"{channel}: {count} of {int(known.sum())} windows have a trend (max-T, p ≤ {LEVEL:g})"
        found = clusters[(clusters["channel"] == channel) & (clusters["p"] <= LEVEL)]
        parts = [
            f"{windows_words(row['layers'], row['sectors'], str(own['p_fwer'].dims[-1]))} "
            f"({signed(row['difference'])}{_unit(own)} by {step}, {p_words(row['p'])})"
            for _, row in found.head(3).iterrows()
        ]
        more = f" and {len(found) - 3} more" if len(found) > 3 else ""
        named = "cluster" if len(found) == 1 else "clusters"
        yield f"{words}; {named}: {'; '.join(parts)}{more}." if parts else f"{words}."
    tested = scalars[scalars["status"] == "ok"]
    differ = tested[tested["p_fwer"] <= LEVEL].sort_values("p_fwer", kind="stable")
    if len(tested):
        slopes = [
            f"{row['scalar']} {signed(row['difference'])} ({p_words(row['p_fwer'])})"
            for _, row in differ.head(4).iterrows()
        ]
        more = f"; and {len(differ) - 4} more" if len(differ) > 4 else ""
        words = f"Scalars: {len(differ)} of {len(tested)} have a trend (max-T, p ≤ {LEVEL:g})"
        yield f"{words}, by {step}: {'; '.join(slopes)}{more}." if slopes else f"{words}."


def _alone_words(tested: pd.DataFrame) -> str:
    """Which scalars would differ, had each been the only question."""
    alone = tested[tested["p"] <= LEVEL].sort_values("p", kind="stable")
    if not len(alone):
        return ""
    named = ", ".join(alone["scalar"].head(3)) + (f" and {len(alone) - 3} more" if len(alone) > 3 else "")
    return (
        f", the smallest corrected {p_words(tested['p_fwer'].min())}; alone, without a correction for their "
        f"number, {named} {'has' if len(alone) == 1 else 'have'} p ≤ {LEVEL:g}, which counts for the one "
        "that you chose before you looked"
    )


def _scalar_words(row: pd.Series) -> str:
    control, treated = with_minus(row["control"]), with_minus(row["treated"])
    effect, low, high = (with_minus(row[name], 2) for name in ("effect_size", "low", "high"))
    return f"{row['scalar']} {control} → {treated} (g = {effect}, {low} to {high}; {p_words(row['p_fwer'])})"


def _unit(windows: xr.Dataset) -> str:
    unit = str(windows["difference"].attrs.get("units", ""))
    return "" if unit in ("", "1") else f" {unit}"
