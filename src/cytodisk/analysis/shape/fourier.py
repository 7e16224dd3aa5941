"""Fourier descriptors of the outline, by size alone: no place, scale, turn, start or mirror image."""

import numpy as np

from cytodisk.analysis.shape.cell_shape import CellShape
from cytodisk.analysis.shape.feature import FeatureGroup, plain

ORDERS = 20
_LOW = 5  # orders up to here make the coarse shape


def measure_fourier(shape: CellShape) -> dict[str, float]:
    """Amplitudes of the outline's harmonics.

    The outline is written as z(s) = Σ cₖ exp(2πi k s), s the share of its length. Harmonic k is
    the ellipse of cₖ and c₋ₖ; its amplitude √(|cₖ|² + |c₋ₖ|²) is taken relative to that of harmonic 1.

    Parameters
    ----------
    shape : CellShape

    Returns
    -------
    dict of str to float
        By name, see `FOURIER`.

    References
    ----------
    Kuhl and Giardina, "Elliptic Fourier features of a closed contour", 1982,
    doi:10.1016/0146-664X(82)90034-X.
    """
    coefficients = np.abs(np.fft.fft(shape.curve[:, 1] + 1j * shape.curve[:, 0], norm="forward"))
    order = np.arange(1, ORDERS + 1)
    forth, back = coefficients[order], coefficients[-order]
    amplitudes = np.hypot(forth, back)
    relative = amplitudes / amplitudes[0]
    power = relative[1:] ** 2
    weights = power / power.sum() if power.sum() > 0 else np.full(len(power), 1.0 / len(power))
    return {
        "fourier_1": float(min(forth[0], back[0]) / max(forth[0], back[0])),
        **{f"fourier_{k}": float(value) for k, value in zip(order[1:], relative[1:], strict=True)},
        "fourier_fine": float(np.sqrt((relative[_LOW:] ** 2).sum())),
        "fourier_order": float(weights @ order[1:]),
    }


FOURIER = FeatureGroup(
    "fourier",
    (
        plain("fourier_1", "Small / large circle of the outline's first harmonic: 0 round, 1 a line"),
        *(
            plain(f"fourier_{k}", f"Amplitude of harmonic {k} of the outline / that of harmonic 1")
            for k in range(2, ORDERS + 1)
        ),
        plain("fourier_fine", f"Amplitude of harmonics {_LOW + 1} to {ORDERS} together / that of harmonic 1"),
        plain("fourier_order", f"Mean order of harmonics 2 to {ORDERS}, weighted by their power"),
    ),
    measure_fourier,
)
