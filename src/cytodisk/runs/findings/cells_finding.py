"""What a study of single cells shows first."""

from __future__ import annotations

import shlex
from collections.abc import Sequence

from cytodisk.number_words import counted
from cytodisk.runs.findings.doubt_words import bearing_flags
from cytodisk.runs.findings.finding import Finding, listed
from cytodisk.runs.findings.layer_levels import WITHOUT_VALUES, has_channel, layer_levels
from cytodisk.runs.findings.signal_sentences import signal_sentences
from cytodisk.runs.groups.groups import CONDITION
from cytodisk.runs.qc_flags.qc_flag import QCFlag
from cytodisk.runs.qc_flags.study_flags import run_flags
from cytodisk.store.study import Study


def cells_finding(study: Study, flags: Sequence[QCFlag] | None = None) -> Finding:
    """How many cells are mapped, and where their signals are.

    Parameters
    ----------
    study : Study
        Of single cells.
    flags : sequence of QCFlag, optional
        Those of the study, where they are known already.

    Returns
    -------
    Finding
    """
    raised = bearing_flags(run_flags(study) if flags is None else flags)
    sentences = [mapped_sentence(study)]
    levels = layer_levels(study)
    if levels is not None:
        sentences += signal_sentences(study, levels)
    elif has_channel(study):
        sentences.append(WITHOUT_VALUES)
    if raised and levels is not None:
        sentences[-1] = f"{sentences[-1][:-1]}, but QC flags are raised that bear on it: {listed(raised)}."
    return Finding("measured", tuple(sentences), compare_command(study))


def mapped_sentence(study: Study) -> str:
    """What came of the run, in a sentence with its numbers."""
    rows = study.cells
    cells = rows[rows["label"] != 0]
    mapped = cells[cells["status"] == "ok"]
    files = rows["source"].nunique() if "source" in rows else 1
    valid = int(mapped["certificate_valid"].astype(bool).sum())
    words = f"{len(mapped)} of {counted(len(cells), 'cell')}"
    words += f" in {counted(files, 'file')} {'is' if len(mapped) == 1 else 'are'} mapped"
    if len(mapped):
        words += " one to one" if valid == len(mapped) else f", {valid} of them one to one"
    lost = cells.loc[cells["status"] != "ok", "status"].value_counts()
    parts = [words, *(f"{count} {status}" for status, count in lost.items())]
    flagged = int((mapped["qc_flags"].fillna("") != "").sum())
    some = f"{flagged} of the mapped {'has' if flagged == 1 else 'have'} QC flags"
    parts.append(some if flagged else "none of the mapped has a QC flag")
    empty = rows.loc[rows["label"] == 0, "status"].value_counts()
    parts += [f"{counted(count, 'image')} without a cell ({status})" for status, count in empty.items()]
    return "; ".join(parts) + "."


def compare_command(study: Study) -> str:
    """The command that compares a study's conditions; empty with fewer than two."""
    rows = study.cells
    if CONDITION not in rows:
        return ""
    names = [str(name) for name in rows[CONDITION].dropna().unique()]
    if len(names) < 2:
        return ""
    folder = str(study.path)
    return shlex.join(
        ["cytodisk", "population", folder, "--compare", ",".join(names), "-o", f"{folder}_population"]
    )
