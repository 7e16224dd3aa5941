"""What a relaxation found."""

from dataclasses import dataclass

from cytodisk.arrays import FloatArray


@dataclass(frozen=True)
class Relaxed:
    """Result of a relaxation.

    Attributes
    ----------
    vertices_uv : ndarray of shape (V, 2) and dtype float
    steps : int
        Newton steps taken.
    converged : bool
        Whether the decrease that the next Newton step promises fell below the criterion; if not, the map is
        valid but its area error could still fall.
    """

    vertices_uv: FloatArray
    steps: int
    converged: bool
