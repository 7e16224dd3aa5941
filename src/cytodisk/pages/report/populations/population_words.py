"""The words of the page of a population: finding, warnings, what was done as a paper says it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from cytodisk.number_words import counted
from cytodisk.pages.grid_words import grid_words
from cytodisk.pages.population.drawn_population import DrawnPopulation
from cytodisk.pages.report.provenance_words import version_of
from cytodisk.population.significance import LEVEL
from cytodisk.runs.findings.finding import listed

_MOST_COMPARISONS = 4
_AGAINST, _MOST_PLACES = " against ", 2  # sentences that tell where, by channel
_NORMALISED = {
    "cell mean": "were divided by the mean of their cell",
    "cell total": "were divided by the total of their cell",
    "z-score": "were expressed in standard deviations of their cell around its mean",
    "background": "were reduced by the background",
}


def facts(one: DrawnPopulation) -> Iterator[tuple[str, str]]:
    """What the head of the page says."""
    study = one.study
    yield "cells", str(len(one.used))
    for name in one.conditions:
        own = one.used[one.used["condition"] == name]
        known = own.loc[own["experiment"] != "", "experiment"].nunique()
        among = f" in {counted(known, 'experiment')}" if known else ", experiments unknown"
        yield name, f"{counted(len(own), 'cell')}{among}"
    if one.channels and not study.is_curves:
        yield "windows", grid_words(one.grid)
    yield "cytodisk", version_of(one.study.provenance)


def headline(one: DrawnPopulation) -> str:
    """What was found, in a sentence with its numbers; where nothing can be found, that comes first."""
    rows = one.study.comparisons
    tested = rows[rows["design"].isin(["paired", "unpaired"])]
    able = tested[tested["smallest_p_holm"] <= LEVEL]
    if able.empty:
        return one.study.sentences[0] if one.study.sentences else "Nothing was compared."
    return " ".join(_found(row) for row in able.head(_MOST_COMPARISONS).to_dict("records"))


def finding(one: DrawnPopulation) -> list[str]:
    """What was found, in one to three sentences: the headline, with its warnings, and where it was found."""
    first = headline(one)
    names = list(dict.fromkeys(warning.name for warning in one.study.warnings))
    told = one.study.sentences
    if names and first not in told:  # where nothing can be found, that is the warning
        first = f"{first.removesuffix('.')}, but warnings bear on this: {listed(names)}."
    where = [words for words in told if _AGAINST in words and words != first]
    return [first, *where[:_MOST_PLACES]]


def _found(row: dict[Any, Any]) -> str:
    windows, clusters, scalars = (int(row[f"{name}_found"]) for name in ("windows", "clusters", "scalars"))
    head = f"{row['condition']} against {row['control']}: "
    found = [f"{windows} of {row['windows_tested']} windows"] if windows else []
    found += [counted(clusters, "cluster")] if clusters else []
    found += [counted(scalars, "scalar")] if scalars else []
    if row["design"] == "paired":
        units = f"{row['n_control']} pairs"
    else:
        units = f"{row['n_control']} + {row['n_treated']} {row['unit']}s"
    best = f"{units}, smallest p possible {row['smallest_p_holm']:.2g}"
    if not found:
        return f"{head}no window, cluster or scalar differs ({best})."
    differ = "differs" if len(found) == 1 and windows + clusters + scalars == 1 else "differ"
    listed = " and ".join(filter(None, [", ".join(found[:-1]), found[-1]]))
    return f"{head}{listed} {differ} ({best})."


def warning_groups(one: DrawnPopulation) -> list[dict[str, str]]:
    """Warnings by name; those of all comparisons alike stand once."""
    seen: dict[tuple[str, str, str, str], list[str]] = {}
    for warning in one.study.warnings:
        key = (warning.name, warning.finding, warning.consequence, warning.remedy)
        about = f"{warning.condition} against {warning.control}" if warning.condition else ""
        seen.setdefault(key, []).append(about)
    return [
        {
            "name": name,
            "finding": finding,
            "consequence": consequence,
            "remedy": remedy,
            "about": "; ".join(filter(None, abouts)),
        }
        for (name, finding, consequence, remedy), abouts in seen.items()
    ]


def methods(one: DrawnPopulation) -> str:
    """What was done, as a paper may say it."""
    study, settings = one.study, one.study.parameters
    words = []
    if one.channels and not study.is_curves:
        words.append(
            f"Cells were mapped one to one onto the unit disk and divided into {grid_words(one.grid)} "
            f"(cytodisk {version_of(one.study.provenance)})."
        )
    normalised = str(settings.get("normalise") or "none")
    if normalised in _NORMALISED:
        words.append(f"Values of windows {_NORMALISED[normalised]}.")
    if one.direction_words:
        words.append(f"Each cell was turned by whole sectors, so that sector 0 lies {one.direction_words}.")
    words += _tests(one)
    return " ".join(words)


def _tests(one: DrawnPopulation) -> Iterator[str]:
    rows = one.study.comparisons
    tested = rows[rows["design"].isin(["paired", "unpaired"])]
    if tested.empty:
        yield "Conditions were described, not tested."
        return
    first = tested.iloc[0]
    unit = "cells" if first["unit"] == "cell" else "experiments"
    if first["unit"] != "cell":
        yield "Values were averaged over the cells of each experiment, and experiments were compared."
    else:
        yield "Cells were treated as independent of each other."
    how = (
        "by swapping the conditions within experiments"
        if first["design"] == "paired"
        else f"by exchanging the labels of whole {unit} between the two conditions"
        if unit == "experiments"
        else "by exchanging the labels of cells between the two conditions"
    )
    count = one.study.parameters.get("permutations", 9999)
    for row in tested.to_dict("records"):
        name, control = row["condition"], row["control"]
        number = (
            f"n = {row['n_control']} pairs"
            if row["design"] == "paired"
            else f"n = {row['n_control']} and {row['n_treated']} {unit}"
        )
        best = f"smallest p possible {row['smallest_p_holm']:.2g}"
        yield f"{name} was compared with {control} ({number}; {best})."
    yield (
        f"Two-sided p values are from permutations, {how} (all of them, or {count} at random where there are "
        "more), corrected over all windows and channels by the largest statistic (max-T); clusters of "
        "neighbouring windows by their largest mass. Effect sizes are Hedges' g over "
        f"{unit} with 95 % intervals."
    )
    if len(tested) > 1:
        yield "p values of several conditions against one control were corrected by Holm's method."


def curves_note(one: DrawnPopulation) -> str:
    """What windows are where curves are compared."""
    unit = one.lag_unit
    return (
        f"Curves over lags{f' in {unit}' if unit else ''} are compared, lag by lag."
        if one.study.is_curves
        else ""
    )


def figure_files(one: DrawnPopulation) -> list[dict[str, Any]]:
    """Figures for print that stand beside the page."""
    folder = one.study.path / "figures"
    if not folder.is_dir():
        return []
    names = sorted(file.name for file in folder.iterdir() if file.suffix in (".png", ".pdf", ".svg"))
    return [{"name": name, "link": f"figures/{name}"} for name in names]
