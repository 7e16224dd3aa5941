"""A study with the waves of one signal alone, for the flags of these."""

from __future__ import annotations

from dataclasses import dataclass

from cytodisk.runs.qc_flags.one_correlation import StudyOfNone
from cytodisk.store.study import Study
from cytodisk.store.waves.waves_store import Waves


@dataclass(frozen=True, repr=False)
class StudyOfWaves(StudyOfNone):
    """A study that knows of the waves of one signal.

    Attributes
    ----------
    found : Waves
    """

    found: Waves

    @property
    def wave_signals(self) -> list[tuple[str, ...]]:
        """The one there is."""
        return [(self.found.signal, self.found.name) if self.found.name else (self.found.signal,)]

    def waves(self, signal: str = "velocity", name: str = "") -> Waves:
        """Those there are."""
        return self.found


def with_waves(study: Study, found: Waves) -> Study:
    """The study as if nothing else had been computed from it.

    Parameters
    ----------
    study : Study
    found : Waves

    Returns
    -------
    Study
    """
    return StudyOfWaves(study.path, study.cells, study.provenance, found)
