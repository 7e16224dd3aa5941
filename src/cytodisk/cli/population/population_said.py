"""What `cytodisk population` says at its end."""

from typing import TYPE_CHECKING

from cytodisk.cli.console import count

if TYPE_CHECKING:
    from rich.console import Console

    from cytodisk.store.populations.population_study import PopulationStudy, StudyWarning

_MOST_REASONS = 8


def say_population(console: "Console", study: "PopulationStudy") -> None:
    """Say what can be reached, the design, what was found, and what speaks against it."""
    for sentence in study.sentences:
        console.print(sentence)
    console.print(cells_words(study))
    for line in left_out_lines(study):
        console.print(line)
    for warning in study.warnings:
        console.print(warning_line(warning))
    for note in study.provenance.get("warnings", ()):
        console.print(f"Warning: {note}")


def cells_words(study: "PopulationStudy") -> str:
    """How many cells of which conditions and experiments, as "24 cells: control 12 (4 experiments), …"."""
    used = study.cells[study.cells["left_out"].fillna("") == ""]
    parts = []
    for name in study.conditions:
        own = used[used["condition"] == name]
        known = own["experiment"].dropna()
        number = known[known != ""].nunique()
        of = f" in {count(number, 'experiment')}" if number else ", experiments unknown"
        parts.append(f"{name} {len(own)}{of}")
    return f"{count(len(used))}: {'; '.join(parts)}"


def left_out_lines(study: "PopulationStudy") -> list[str]:
    """Cells and files that are in no mean, by reason."""
    own = study.cells["left_out"].fillna("")
    reasons = [*own[own != ""], *study.excluded["reason"].fillna("it cannot be read")]
    by_reason: dict[str, int] = {}
    for reason in reasons:
        by_reason[str(reason)] = by_reason.get(str(reason), 0) + 1
    most = sorted(by_reason.items(), key=lambda pair: -pair[1])
    lines = [f"left out ({number}): {reason}" for reason, number in most[:_MOST_REASONS]]
    more = len(most) - _MOST_REASONS
    return [*lines, f"… and {more} more reasons: excluded.parquet"] if more > 0 else lines


def warning_line(warning: "StudyWarning") -> str:
    """A warning with its name first and its remedy last."""
    about = f" ({warning.condition} against {warning.control})" if warning.condition else ""
    return f"Warning {warning.name}{about}: {warning.finding} {warning.consequence} {warning.remedy}"
