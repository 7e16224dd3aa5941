"""Moments of a cell's area that do not depend on place, size, turn or mirror image."""

import numpy as np
from skimage import measure

from cytodisk.analysis.shape.cell_shape import CellShape
from cytodisk.analysis.shape.feature import FeatureGroup, plain

_ORDERS = ((1, 1), (2, 0), (2, 1), (3, 0), (2, 2), (3, 1), (4, 0))
_HU_DEGREES = np.array([1, 2, 2, 2, 4, 3, 4])  # in the normalised central moments
_HU_FLOOR = 1e-4  # of a normalised central moment: what is smaller is the pixels', not the cell's


def measure_moments(shape: CellShape) -> dict[str, float]:
    """Complex moments up to order 4 and Hu moments.

    Parameters
    ----------
    shape : CellShape

    Returns
    -------
    dict of str to float
        By name, see `MOMENTS`.

    References
    ----------
    Flusser, "On the independence of rotation moment invariants", 2000, doi:10.1016/S0031-3203(99)00127-2.
    Hu, "Visual pattern recognition by moment invariants", 1962, doi:10.1109/TIT.1962.1057692.
    """
    place = (shape.pixels[:, 1] + 1j * shape.pixels[:, 0]) / np.sqrt(shape.area)
    powers = [np.ones_like(place)]
    for _ in range(4):
        powers.append(powers[-1] * place)
    complex_moments = {
        f"moment_{p}{q}": float(np.abs(np.vdot(powers[q], powers[p])) / shape.area) for p, q in _ORDERS
    }
    return complex_moments | _hu(shape)


def _hu(shape: CellShape) -> dict[str, float]:
    central = measure.moments_central(shape.mask, order=3)  # type: ignore[no-untyped-call,unused-ignore]
    normalised = measure.moments_normalized(central)  # type: ignore[no-untyped-call,unused-ignore]
    hu = np.abs(measure.moments_hu(normalised))  # type: ignore[no-untyped-call,unused-ignore]
    logs = np.log10(np.maximum(hu, _HU_FLOOR**_HU_DEGREES)) / _HU_DEGREES
    return {f"hu_{number}": float(value) for number, value in enumerate(logs, start=1)}


MOMENTS = FeatureGroup(
    "moments",
    (
        *(
            plain(f"moment_{p}{q}", f"Size of the complex moment ∫ zᵖ z̄^q with p = {p}, q = {q}, normalised")
            for p, q in _ORDERS
        ),
        *(
            plain(f"hu_{number}", f"log10 of the size of Hu moment {number}, / its degree in the moments")
            for number in range(1, 8)
        ),
    ),
    measure_moments,
)
