"""`compare_with_control`: several conditions, each against one control."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from cytodisk.arrays import FloatArray
from cytodisk.checks import instance_of
from cytodisk.errors import PopulationError
from cytodisk.population.comparison_parameters import ComparisonParameters
from cytodisk.population.conditions.comparison_sentences import found_words
from cytodisk.population.conditions.condition_comparison import ConditionComparison, compare_conditions
from cytodisk.population.named_warning import NamedWarning
from cytodisk.population.population import Population
from cytodisk.population.significance import LEVEL
from cytodisk.taking import takes


@takes(ComparisonParameters)
def compare_with_control(
    pop: Population,
    control: str,
    others: Sequence[str] | None = None,
    *,
    channel: str | Sequence[str] | None = None,
    progress: Callable[[int, int], None] | None = None,
    parameters: ComparisonParameters | None = None,
    **settings: Any,
) -> dict[str, ConditionComparison]:
    """Compare several conditions with one control.

    Labels are exchanged between the two conditions of a comparison alone, and the p-values are corrected over
    the comparisons by Holm's procedure.

    Parameters
    ----------
    pop : Population
    control : str
    others : sequence of str, optional
        By default all conditions but the control.
    channel : str or sequence of str, optional
        By default all.
    progress : callable, optional
        Called with (exchanges done, exchanges in all), over all comparisons.
    parameters : ComparisonParameters, optional
        All parameters together; those that are given by name overrule them.
    **settings
        See `ComparisonParameters`.

    Returns
    -------
    dict of str to ConditionComparison
        By name of the other condition. Windows, clusters and scalars have `p_holm` beside: p_fwer of windows
        and scalars, and p of clusters, corrected over the comparisons.

    Raises
    ------
    PopulationError
        As `compare_conditions`, or there is no other condition.

    Notes
    -----
    Holm (1979). A family is all windows (or clusters, or scalars) of a comparison; it counts in the
    correction of the others until all of its members differ, so windows are corrected for all comparisons.

    Examples
    --------
    >>> import cytodisk as cd
    >>> truth = cd.simulate.population(experiments=4, effect=3.0, seed=0)
    >>> pop = cd.Population(truth.values, truth.cells)
    >>> found = cd.compare_with_control(pop, "control")
    >>> list(found), "p_holm" in found["drug"].windows
    (['drug'], True)
    """
    instance_of("pop", pop, Population, "a Population")
    wanted = [name for name in pop.conditions if name != control] if others is None else others
    names = list(dict.fromkeys(wanted))
    if isinstance(others, str):
        names = [others]
    if not names:
        raise PopulationError(f"there is no condition beside {control!r} to compare it with")
    found = {}
    for place, name in enumerate(names):
        part = _part_of(progress, place, len(names))
        found[name] = compare_conditions(
            pop, control, name, channel=channel, progress=part, parameters=parameters, **settings
        )
    windows = holm({name: one.windows["p_fwer"].values for name, one in found.items()})
    largest = {name: np.append(one.clusters["p"].to_numpy(np.float64), 1.0) for name, one in found.items()}
    clusters = {name: p[:-1] for name, p in holm(largest).items()}  # one without clusters counts, too
    scalars = holm({name: one.scalars["p_fwer"].to_numpy(np.float64) for name, one in found.items()})
    corrected = {
        name: replace(
            one,
            windows=one.windows.assign(p_holm=(one.windows["p_fwer"].dims, windows[name])),
            clusters=one.clusters.assign(p_holm=clusters[name]),
            scalars=one.scalars.assign(p_holm=scalars[name]),
        )
        for name, one in found.items()
    }
    return _told(corrected) if len(corrected) > 1 else corrected


def smallest_corrected(found: Mapping[str, ConditionComparison]) -> dict[str, float]:
    """The smallest p_holm that each comparison with the control can give.

    The first one that is rejected has the smallest p of all times the number of comparisons.

    Parameters
    ----------
    found : dict of str to ConditionComparison

    Returns
    -------
    dict of str to float
    """
    first = min((len(found) * one.smallest_p for one in found.values()), default=np.nan)
    return {name: min(max(first, one.smallest_p), 1.0) for name, one in found.items()}


def _told(found: Mapping[str, ConditionComparison]) -> dict[str, ConditionComparison]:
    """Sentences and warnings of comparisons that are corrected for each other."""
    best = smallest_corrected(found)
    return {
        name: replace(
            one,
            sentences=tuple(_sentences(one, len(found), best[name])),
            warnings=(*_too_many(len(found), best[name], one.smallest_p), *one.warnings),
        )
        for name, one in found.items()
    }


def _sentences(one: ConditionComparison, count: int, best: float) -> Iterator[str]:
    """Those of the comparison, with what was found by its corrected p."""
    names = one.control, one.treated
    windows = one.windows if "channel" in one.windows.dims else one.windows.expand_dims("channel")
    alone = [*found_words(names, windows, one.clusters, one.scalars)]
    nothing = f": no difference can then reach {LEVEL:g}" if best > LEVEL else ""
    yield f"{one.sentences[0]} Corrected for {count} comparisons (Holm) it is {best:.2g} at best{nothing}."
    yield from one.sentences[1 : len(one.sentences) - len(alone)]
    yield f"{count} conditions were compared with the control, and each p is corrected for that (Holm)."
    windows = windows.assign(p_fwer=windows["p_holm"])
    clusters = one.clusters.assign(p=one.clusters["p_holm"])
    scalars = one.scalars.assign(p_fwer=one.scalars["p_holm"])
    yield from found_words(names, windows, clusters, scalars, "max-T and Holm")


def _part_of(
    progress: Callable[[int, int], None] | None, place: int, count: int
) -> Callable[[int, int], None] | None:
    """What one comparison of several reports to."""
    if progress is None:
        return None
    return lambda done, total: progress(place * total + done, count * total)


def holm(families: Mapping[str, FloatArray]) -> dict[str, FloatArray]:
    """p-values of families corrected over the families.

    Holm's procedure, in which a family counts until all of its members are rejected: while a member is left,
    chance has one more family to err in (Goeman & Solari 2010, doi:10.1214/10-AOS829).

    Parameters
    ----------
    families : dict of str to ndarray of any shape
        p-values that hold within the family; NaN for what is not tested.

    Returns
    -------
    dict of str to ndarray

    Examples
    --------
    >>> import numpy as np
    >>> from cytodisk.population.conditions.with_control import holm
    >>> found = holm({"a": np.array([0.01, 0.3]), "b": np.array([0.04])})
    >>> found["a"].tolist(), found["b"].tolist()
    ([0.02, 0.3], [0.08])
    """
    every = np.concatenate([np.ravel(p) for p in families.values()])
    family = np.repeat(np.arange(len(families)), [np.size(p) for p in families.values()])
    order = np.argsort(every, kind="stable")
    order = order[np.isfinite(every[order])]
    number = np.arange(len(order))
    last = [number[family[order] == one].max(initial=-1) for one in range(len(families))]
    left = (np.array(last)[:, None] >= number).sum(axis=0)  # families that are not rejected as wholes before
    corrected = np.full(len(every), np.nan)
    corrected[order] = np.minimum(np.maximum.accumulate(left * every[order]), 1.0)
    parts = np.split(corrected, np.cumsum([np.size(p) for p in families.values()])[:-1])
    return {name: part.reshape(np.shape(p)) for (name, p), part in zip(families.items(), parts, strict=True)}


def _too_many(count: int, best: float, alone: float) -> Iterator[NamedWarning]:
    """More comparisons than the number of experiments can bear: none can be rejected."""
    if alone <= LEVEL < best:
        yield NamedWarning(
            "too few experiments",
            f"Corrected for {count} comparisons with the control, p is {best:.2g} at best.",
            f"No difference, however large, can reach p_holm ≤ {LEVEL:g}.",
            "Repeat the experiment: 5 + 5 experiments can give 0.0079, 7 pairs 0.016, before the correction. "
            "Compare one condition alone, as with --compare control,drug, only if you chose it before you "
            "saw the results.",
        )
