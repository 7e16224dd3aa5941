"""`NucleusReport`: what fitting a nucleus into its cell changed."""

from dataclasses import dataclass
from typing import Literal, TypeAlias

SeveralPolicy: TypeAlias = Literal["refuse", "largest", "join"]
"""What becomes of several nuclei in one cell."""


@dataclass(frozen=True)
class NucleusReport:
    """What fitting a nucleus into its cell found and changed. Areas in pixels.

    The pixels that were given are ``area_px + dropped_px + outside_px + clipped_px - filled_px - joined_px``.

    Attributes
    ----------
    area_px : int
        Pixels of the nucleus as it is mapped.
    n_nuclei : int
        Nuclei that came: pieces (8-connected, each within one label) of at least a tenth of the largest.
    dropped_px : int
        Pixels of pieces that were left out: specks, and other nuclei with ``several="largest"``.
    holes, filled_px : int
        Holes that were filled, and their pixels; they are part of the nucleus now.
    outside_px : int
        Pixels outside the cell, which were clipped.
    clipped_px : int
        Pixels inside the cell that were clipped, because they touched its edge or were cut off with those.
    clipped_share : float
        Share of the outline as it came that lay at or beyond the cell's edge, 0 to 1.
    joined_px : int
        Pixels of the paths that join several nuclei.

    Examples
    --------
    >>> import numpy as np
    >>> import cytodisk as cd
    >>> cell = cd.simulate.disk(20)
    >>> nucleus = np.zeros_like(cell)
    >>> nucleus[20:30, 22:30] = True
    >>> nucleus[25, 25] = False
    >>> _, report = cd.fit_nucleus(cell, nucleus)
    >>> report.n_nuclei, report.area_px, report.notes
    (1, 80, ('1 hole of the nucleus filled (1 px)',))
    """

    area_px: int
    n_nuclei: int = 1
    dropped_px: int = 0
    holes: int = 0
    filled_px: int = 0
    outside_px: int = 0
    clipped_px: int = 0
    clipped_share: float = 0.0
    joined_px: int = 0

    @property
    def notes(self) -> tuple[str, ...]:
        """What a user should know, in words; empty when nothing was changed."""
        notes = []
        if self.joined_px or (self.n_nuclei > 1 and not self.dropped_px):
            notes.append(f"{self.n_nuclei} nuclei joined (by {self.joined_px} px)")
        elif self.n_nuclei > 1:
            notes.append(f"the largest of {self.n_nuclei} nuclei taken ({self.dropped_px} px dropped)")
        elif self.dropped_px:
            notes.append(f"specks beside the nucleus dropped ({self.dropped_px} px)")
        if self.holes:
            holes = "1 hole" if self.holes == 1 else f"{self.holes} holes"
            notes.append(f"{holes} of the nucleus filled ({self.filled_px} px)")
        if self.outside_px:
            notes.append(f"{self.outside_px} px of the nucleus outside the cell clipped")
        if self.clipped_px:
            notes.append(f"{self.clipped_px} px of the nucleus at the cell's edge clipped")
        return tuple(notes)

    @property
    def qc_flags(self) -> tuple[str, ...]:
        """What speaks against this being the nucleus of one cell, in words; a user should look at it."""
        qc_flags = []
        if self.n_nuclei > 1:
            qc_flags.append(f"{self.n_nuclei} nuclei: perhaps several cells, or a nucleus in fragments")
        if self.outside_px or self.clipped_px:
            qc_flags.append(
                f"nucleus clipped: {self.clipped_share:.1%} of its outline lay at the cell's edge or outside"
            )
        return tuple(qc_flags)
