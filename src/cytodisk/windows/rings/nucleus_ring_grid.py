"""`NucleusRingGrid`: how many layers of cytoplasm and nucleus rings divide a cell into."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from cytodisk.arrays import AnyArray
from cytodisk.errors import WindowError
from cytodisk.windows.rings.nucleus_ring_parameters import InterpolatedRingParameters, NucleusRingParameters


@dataclass(frozen=True)
class NucleusRingGrid:
    """Rings by the share of the way from the edge (0) to the nucleus, rings in it, and wedges around it.

    Attributes
    ----------
    layers, sectors : int
        All layers, those of the nucleus too.
    nucleus_layers : int
        How many of the layers are in the nucleus, the last ones.

    Raises
    ------
    WindowError
        A count is not a positive whole number, or no layer is left for the cytoplasm.

    See Also
    --------
    nucleus_ring_windows : Lays one over a cell.

    Examples
    --------
    >>> import cytodisk as cd
    >>> grid = cd.NucleusRingGrid(layers=3, sectors=8, nucleus_layers=1)
    >>> grid.compartments.tolist()
    ['cytoplasm', 'cytoplasm', 'nucleus']
    """

    layers: int
    sectors: int
    nucleus_layers: int = 3

    def __post_init__(self) -> None:
        self._check(NucleusRingParameters)

    def _check(self, model: type[NucleusRingParameters], **more: Any) -> None:
        counts = {"layers": self.layers, "sectors": self.sectors, "nucleus_layers": self.nucleus_layers}
        model(**counts, **more)
        if self.layers <= self.nucleus_layers:
            raise WindowError(
                f"layers must be more than nucleus_layers, of which it counts the cytoplasm's too, got "
                f"{self.layers} and {self.nucleus_layers}"
            )

    @property
    def cytoplasm_layers(self) -> int:
        """How many of the layers are in the cytoplasm, the first ones."""
        return self.layers - self.nucleus_layers

    @property
    def compartments(self) -> AnyArray:
        """Compartment of each layer, "cytoplasm" or "nucleus", shape (layers,)."""
        return np.array(["cytoplasm"] * self.cytoplasm_layers + ["nucleus"] * self.nucleus_layers)


@dataclass(frozen=True)
class InterpolatedRingGrid(NucleusRingGrid):
    """Rings interpolated point by point between two outlines, and sectors along both.

    Attributes
    ----------
    layers, sectors : int
        All layers, those of the nucleus too.
    nucleus_layers : int
        How many of the layers are in the nucleus, the last ones.
    points : int
        On each ring, at least; there are equally many in each sector.
    harmonics : int or None
        Fourier harmonics of the outlines that are kept; None for the outlines as they are.

    Raises
    ------
    WindowError
        A count is not a positive whole number, or no layer is left for the cytoplasm.

    See Also
    --------
    interpolated_ring_windows : Lays one over a cell.

    Examples
    --------
    >>> import cytodisk as cd
    >>> cd.InterpolatedRingGrid(layers=11, sectors=60, nucleus_layers=3).n_points
    300
    """

    points: int = 256
    harmonics: int | None = None

    def __post_init__(self) -> None:
        self._check(InterpolatedRingParameters, points=self.points, harmonics=self.harmonics)

    @property
    def n_points(self) -> int:
        """Number of points on each ring: a multiple of the sectors."""
        return -(-self.points // self.sectors) * self.sectors
