"""Compare the conditions of a population with the control, or say why nothing can be tested."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from cytodisk.errors import PopulationError
from cytodisk.population.comparison_parameters import ComparisonParameters, DoseParameters
from cytodisk.population.conditions.condition_comparison import ConditionComparison
from cytodisk.population.conditions.dose_trend import DoseTrend, dose_trend
from cytodisk.population.conditions.with_control import compare_with_control
from cytodisk.population.group_columns import CONDITION, EXPERIMENT, names_in
from cytodisk.population.population import Population
from cytodisk.runs.population.conditions_compared import ComparedConditions
from cytodisk.runs.population.population_parameters import PopulationParameters
from cytodisk.store.populations.population_study import StudyWarning

UNKNOWN = "experiments unknown"


@dataclass(frozen=True)
class Compared:
    """What was tested.

    Attributes
    ----------
    found : dict of str to ConditionComparison
        By the condition that is compared with the control; empty where nothing is tested.
    trend : DoseTrend or None
    why : str
        Why nothing is tested; empty if something is.
    sentences : tuple of str
        What can be reached first, then the design, the control, the findings.
    warnings : tuple of StudyWarning
    """

    found: dict[str, ConditionComparison] = field(default_factory=dict)
    trend: DoseTrend | None = None
    why: str = ""
    sentences: tuple[str, ...] = ()
    warnings: tuple[StudyWarning, ...] = ()


def compared(
    population: Population,
    chosen: ComparedConditions,
    parameters: PopulationParameters,
    step: Callable[[float], None],
) -> Compared:
    """Compare each condition with the control.

    Parameters
    ----------
    population : Population
        Normalised and aligned; the cells of the conditions that are shown.
    chosen : ComparedConditions
    parameters : PopulationParameters
    step : callable
        Called with the share of the comparisons that is done.

    Returns
    -------
    Compared
    """
    if parameters.unit == "experiment" and not population.experiments and (chosen.control or parameters.dose):
        return _of_unknown_experiments(population, chosen)
    found = _with_control(population, chosen, parameters, step) if chosen.control else {}
    trend = _trend(population, parameters)
    warnings = [
        StudyWarning(name, chosen.control, one.name, one.finding, one.consequence, one.remedy)
        for name, comparison in found.items()
        for one in comparison.warnings
    ]
    why = "" if found else "nothing is compared, as there is one condition"
    return Compared(found, trend, why, _sentences(found, trend, chosen), tuple(_once(warnings)))


def _with_control(
    population: Population,
    chosen: ComparedConditions,
    parameters: PopulationParameters,
    step: Callable[[float], None],
) -> dict[str, ConditionComparison]:
    return compare_with_control(
        population,
        chosen.control,
        chosen.treated,
        progress=lambda done, total: step(done / max(total, 1)),
        parameters=parameters.part(ComparisonParameters),
    )


def _trend(population: Population, parameters: PopulationParameters) -> DoseTrend | None:
    if parameters.dose is None:
        return None
    if parameters.dose not in population.cells:
        raise PopulationError(
            f"dose: the cells have no column {parameters.dose!r}: give each cell its dose, a number, in the "
            "table of groups, or leave --dose out"
        )
    how = DoseParameters(
        scale=parameters.dose_scale, permutations=parameters.permutations, seed=parameters.seed
    )
    return dose_trend(population, parameters.dose, parameters=how)


def _sentences(
    found: dict[str, ConditionComparison], trend: DoseTrend | None, chosen: ComparedConditions
) -> tuple[str, ...]:
    """What can be reached, how the designs were found, the control, the findings; each sentence once."""
    reach: list[str] = []
    design: list[str] = []
    finding: list[str] = []
    several = len(found) > 1
    of_all = set.intersection(*(set(one.sentences[2:]) for one in found.values())) if several else set()
    for name, one in found.items():
        pair = f"{name} against {chosen.control}"
        before = f"{pair}: " if several else ""
        reach.append(before + one.sentences[0])
        design.append(before + one.sentences[1])
        finding += [
            words if not several or words in of_all or pair in words else f"{pair}: {words}"
            for words in one.sentences[2:]
        ]
    if trend is not None:
        reach.append(trend.sentences[0])
        finding += trend.sentences[1:]
    control = [chosen.sentence] if chosen.sentence else []
    return tuple(dict.fromkeys([*reach, *design, *control, *finding]))


def _once(warnings: list[StudyWarning]) -> list[StudyWarning]:
    """Warnings that several comparisons have in the same words, once, without the conditions."""
    by_words: dict[tuple[str, ...], list[StudyWarning]] = {}
    for one in warnings:
        by_words.setdefault(tuple(one[2:]), []).append(one)
    of_all = {"condition": "", "control": ""}
    return [some[0] if len(some) == 1 else some[0]._replace(**of_all) for some in by_words.values()]


def _of_unknown_experiments(population: Population, chosen: ComparedConditions) -> Compared:
    """Conditions that are shown and described, without a test."""
    counts = names_in(population.cells, CONDITION).value_counts()
    numbers = ", ".join(f"{counts.get(name, 0)} of {name}" for name in chosen.names)
    reach = (
        f"Nothing can be tested: of the cells ({numbers}) no {EXPERIMENT} (day, dish, animal) is known, and "
        "cells of one dish are not independent."
    )
    cannot = (
        "What is shown describes these cells. It cannot be concluded that the conditions differ beyond them: "
        "a difference between the conditions and one between dishes or days look the same."
    )
    warning = StudyWarning(
        "",
        "",
        UNKNOWN,
        f"No cell has an {EXPERIMENT}.",
        "Nothing is tested, and no difference can be ascribed to the condition.",
        "Add a column experiment, with --groups table.csv or in the batch file; --unit cell tests cells as "
        "if they were independent, which finds differences where there are none.",
    )
    sentences = tuple(filter(None, (reach, cannot, chosen.sentence)))
    return Compared(why="no experiment is known", sentences=sentences, warnings=(warning,))
