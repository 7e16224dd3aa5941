"""A figure of `suite.py`: a measured number beside its yardstick."""

from dataclasses import dataclass


class MissingError(Exception):
    """This revision of the package, or this machine, lacks what a block measures."""


@dataclass(frozen=True)
class Figure:
    """One measured number beside its yardstick.

    Attributes
    ----------
    what : str
    value : float
    unit : str
    least, most : float or None
        What the value must reach or not exceed; None where nothing is asked.
    note : str
        What else is to be known.
    """

    what: str
    value: float
    unit: str = ""
    least: float | None = None
    most: float | None = None
    note: str = ""

    @property
    def met(self) -> bool | None:
        """Whether the yardstick is met, or None if there is none."""
        if self.least is None and self.most is None:
            return None
        above = self.least is None or self.value >= self.least
        return above and (self.most is None or self.value <= self.most)

    @property
    def yardstick(self) -> str:
        """The yardstick in words."""
        if self.least is None:
            return "" if self.most is None else f"≤ {self.most:g} {self.unit}".strip()
        return (
            f"≥ {self.least:g} {self.unit}".strip() if self.most is None else f"{self.least:g}–{self.most:g}"
        )

    @property
    def measured(self) -> str:
        """The value in words."""
        whole = float(self.value).is_integer() and abs(self.value) < 1e6
        return f"{self.value:.0f} {self.unit}".strip() if whole else f"{self.value:.3g} {self.unit}".strip()
