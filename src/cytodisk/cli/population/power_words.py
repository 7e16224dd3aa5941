"""What `cytodisk population --power` says."""

from typing import TYPE_CHECKING

from cytodisk.population.significance import LEVEL

if TYPE_CHECKING:
    from collections.abc import Callable

    import pandas as pd
    from rich.console import Console

    from cytodisk.runs.population.power.population_power import Plan
    from cytodisk.runs.population.power.power_parameters import PowerParameters

_WIDE, _NARROW = 16, 13
_DESIGNS = {
    "unpaired": ("unpaired: each experiment holds one condition", "{0} + {0}"),
    "paired": ("paired: each experiment holds both conditions", "{0} pairs"),
}


def plan_lines(plan: "Plan", parameters: "PowerParameters") -> list[str]:
    """Which variances the plan is for, and whether they are those of cells at hand."""
    shares = (
        f"{plan.between_experiments:.0%} of the variance of cells between experiments, "
        f"{plan.between_dishes:.0%} between the conditions of one experiment, {plan.cells} cells of each "
        "condition in each experiment"
    )
    names = ("between_experiments", "between_dishes", "cells")
    given = [name for name in names if getattr(parameters, name) is not None]
    if plan.measured is None:
        if len(given) == len(names):
            return [f"as given: {shares}"]
        return [
            f"assumed, not measured: {shares}",
            "pass PATH, a batch or study with conditions and experiments, to plan with the variance of your "
            "own cells; or --between-experiments, --between-dishes and --cells",
        ]
    measured = plan.measured
    where = f"in your {measured.experiments} experiments, {measured.conditions} conditions"
    lines = [f"measured {where}{' and as given' if given else ''}: {shares}"]
    if measured.experiments < 6:
        lines.append("so few experiments tell their variance roughly: plan for more than the table says")
    if not measured.separate:
        lines.append(
            "each experiment holds one condition, so that nothing tells how much of the variance pairs would "
            "take away: all of it is taken for shared by pairs, which makes the paired rows too good"
        )
    return lines


def say_power(console: "Console", table: "pd.DataFrame") -> None:
    """Print how often a difference is found, by design, number of experiments and size."""
    for line in power_lines(table):
        console.print(line)


def power_lines(table: "pd.DataFrame") -> list[str]:
    """The lines of `say_power`."""
    attrs = table.attrs
    layers, sectors = attrs["windows"]
    return [
        f"Effects in standard deviations of a cell within its condition; {attrs['studies']} simulated "
        f"studies a number, tested as cytodisk population tests (p ≤ {LEVEL:g}).",
        "",
        f"A region differs, a sixth of {layers} × {sectors} windows: how often it is found as a cluster of "
        "windows, and in brackets which share of its windows is found one by one (max-T):",
        *_blocks(table, lambda row: f"{row['cluster']:.0%} ({row['windows']:.0%})", _WIDE),
        "",
        "One number by cell differs, such as a ratio or an area, tested alone: how often it is found:",
        *_blocks(table, lambda row: f"{row['scalar']:.0%}", _WIDE),
    ]


def _blocks(table: "pd.DataFrame", words: "Callable[[pd.Series[float]], str]", width: int) -> list[str]:
    lines = []
    for design, (title, name) in _DESIGNS.items():
        own = table[table["design"] == design]
        if own.empty:
            continue
        effects = list(dict.fromkeys(own["effect"]))
        lines += [f"  {title}", f"    {'effect':<{_NARROW}}" + "".join(f"{e:<{width}g}" for e in effects)]
        for number, rows in own.groupby("experiments", sort=False):
            first = rows.iloc[0]
            if first["smallest_p"] > LEVEL:
                said = f"nothing: p = {first['smallest_p']:.2g} at best"
            else:
                said = "".join(f"{words(row):<{width}}" for _, row in rows.iterrows())
            lines.append(f"    {name.format(number):<{_NARROW}}{said.rstrip()}")
    return lines
