"""What a shape feature is: its name, its unit and what it says."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from cytodisk.analysis.shape.cell_shape import CellShape


class Feature(NamedTuple):
    """One number that describes a shape.

    Attributes
    ----------
    name : str
        Name of its column.
    unit : {"1", "length", "length²"}
        "length" stands for µm where the scale is known, else for px.
    description : str
        One line.
    """

    name: str
    unit: str
    description: str

    @property
    def scale_free(self) -> bool:
        """Whether it refers to the disk of the same area: see `shape_features` on small cells."""
        return "length" not in self.unit


class FeatureGroup(NamedTuple):
    """Features that are measured together.

    Attributes
    ----------
    name : str
    features : tuple of Feature
    measure : callable
        Takes a CellShape and returns the value of each feature by name, lengths in pixels.
    """

    name: str
    features: tuple[Feature, ...]
    measure: Callable[[CellShape], dict[str, float]]


def length(name: str, description: str) -> Feature:
    """A feature that is a length."""
    return Feature(name, "length", description)


def area(name: str, description: str) -> Feature:
    """A feature that is an area."""
    return Feature(name, "length²", description)


def plain(name: str, description: str) -> Feature:
    """A feature without a unit."""
    return Feature(name, "1", description)
