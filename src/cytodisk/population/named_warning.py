"""`NamedWarning`: a reason to doubt a comparison, with what it means and what to do."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class NamedWarning:
    """One reason to doubt a comparison of conditions.

    Attributes
    ----------
    name : str
        Short and fixed, to be matched by programs, as "too few experiments".
    finding : str
        What was found, as a sentence with its numbers.
    consequence, remedy : str
        What it means for the result, and what to do.
    """

    name: str
    finding: str
    consequence: str
    remedy: str

    def __str__(self) -> str:
        return f"{self.name}: {self.finding} {self.consequence} {self.remedy}"
