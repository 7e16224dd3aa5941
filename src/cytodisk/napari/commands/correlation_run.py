"""What the command correlate does, on a study that is open: done in a thread, without a viewer."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from cytodisk.napari.forms.own_values import with_own
from cytodisk.napari.work.background import Reporter
from cytodisk.runs.correlate.correlate_parameters import CorrelateParameters
from cytodisk.runs.qc_flags.qc_flag import QCFlag
from cytodisk.runs.run_options import TableOptions
from cytodisk.runs.told.speed_words import PERCENT
from cytodisk.store.correlation_store import Correlation
from cytodisk.store.study import Study, open_study


@dataclass
class MadeCorrelation:
    """A correlation that a widget made.

    Attributes
    ----------
    study : Study
    found : Correlation
    lines : list of str
        What the command prints, the finding first.
    flags : list of QCFlag
        Of this correlation.
    """

    study: Study
    found: Correlation
    lines: list[str] = field(default_factory=list)
    flags: Sequence[QCFlag] = ()

    @property
    def cells(self) -> list[int]:
        """Cells that could be correlated."""
        return [int(cell) for cell in self.found.windows["cell"].unique()]


def run_correlation(
    study: Study,
    names: tuple[str, str],
    values: Mapping[str, Any],
    flags: Mapping[str, str],
    report: Reporter,
) -> MadeCorrelation:
    """Correlate a signal of a study, as `cytodisk correlate` does.

    Parameters
    ----------
    study : Study
    names : (str, str)
        Signal, and what it is correlated with.
    values : mapping
        Parameters and options that the user chose, by name.
    flags : mapping of str to str
        What messages call them.
    report : Reporter

    Returns
    -------
    MadeCorrelation
        Written into the study.
    """
    from cytodisk.runs.correlate.correlate_study import correlate_study
    from cytodisk.runs.qc_flags.one_correlation import with_one
    from cytodisk.runs.qc_flags.study_flags import qc_flags
    from cytodisk.runs.told.correlation_words import correlation_lines, finding_lines, verdict_lines

    parameters = with_own(CorrelateParameters, values, flags)
    options = with_own(TableOptions, values, flags)
    there = open_study(study.path)
    report.stage("Correlating", PERCENT)
    found = correlate_study(there, *names, progress=report, parameters=parameters, **dict(options))
    there = open_study(study.path)
    return MadeCorrelation(
        there,
        found,
        [*(list(finding_lines(found, there)) or verdict_lines(found)), *correlation_lines(found, there)],
        qc_flags(with_one(there, found)),
    )
