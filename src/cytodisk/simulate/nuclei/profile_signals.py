"""Signals whose profile between nucleus and membrane is known."""

from collections.abc import Callable
from typing import Literal, get_args

import numpy as np
from scipy import ndimage
from scipy.stats import rankdata

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.checks import number_between, one_of, whole_number
from cytodisk.errors import ParameterError
from cytodisk.simulate.signals import depth

Along = Literal["ratio", "share", "depth", "nucleus distance"]
WAYS: tuple[Along, ...] = get_args(Along)


def profile_signal(
    mask: BoolArray,
    nucleus: BoolArray,
    profile: Callable[[FloatArray], FloatArray],
    *,
    along: Along = "ratio",
    in_nucleus: float = 0.0,
    background: float = 0.0,
    noise_seed: int | None = None,
) -> FloatArray:
    """Image of a signal that depends on the place between nucleus and membrane alone.

    Parameters
    ----------
    mask, nucleus : ndarray of shape (H, W) and dtype bool
    profile : callable
        Takes the places of pixels, shape (N,), and returns the signal there, shape (N,).
    along : {"ratio", "share", "depth", "nucleus distance"}
        What a place is: see `between_nucleus_and_membrane`.
    in_nucleus : float
        Signal in the nucleus.
    background : float
        Added everywhere, outside the cell too.
    noise_seed : int, optional
        The signal counts photons, and each pixel is drawn from a Poisson distribution. Without it there is no
        noise.

    Returns
    -------
    ndarray of shape (H, W) and dtype float

    Raises
    ------
    ParameterError
        The shapes differ, there is no cytoplasm or no nucleus, the profile returns another shape, or a signal
        with noise is negative somewhere.

    See Also
    --------
    between_nucleus_and_membrane : The place of each pixel.
    ring_signal : Without a nucleus.

    Examples
    --------
    >>> import cytodisk as cd
    >>> cell = cd.simulate.cell_with_nucleus("centred")
    >>> signal = cd.simulate.profile_signal(cell.mask, cell.nucleus, lambda place: 100 + 50 * place)
    >>> float(signal[cell.mask & ~cell.nucleus].max().round(-1))  # at the nucleus
    150.0
    """
    place = between_nucleus_and_membrane(mask, nucleus, along)
    cytoplasm = np.isfinite(place)
    found = np.asarray(profile(place[cytoplasm]), dtype=np.float64)
    if found.shape not in ((), (int(cytoplasm.sum()),)):
        raise ParameterError(
            f"profile must return as many values as it is given ({int(cytoplasm.sum())}), "
            f"got shape {found.shape}: write it for arrays"
        )
    signal = np.zeros(place.shape)
    signal[cytoplasm] = found
    signal[np.asarray(nucleus, dtype=bool)] = in_nucleus
    signal += background
    if noise_seed is None:
        return signal
    number_between("signal", float(signal.min()), 0.0)
    random = np.random.default_rng([17, whole_number("noise_seed", noise_seed, 0)])
    return random.poisson(signal).astype(np.float64)


def between_nucleus_and_membrane(mask: BoolArray, nucleus: BoolArray, along: Along = "ratio") -> FloatArray:
    """Place of each pixel of the cytoplasm on the way from the membrane to the nucleus.

    Parameters
    ----------
    mask, nucleus : ndarray of shape (H, W) and dtype bool
        The nucleus may have several pieces; the nearest counts.
    along : {"ratio", "share", "depth", "nucleus distance"}
        "depth": distance to the membrane, in pixels. "nucleus distance": distance to the nuclear outline, in
        pixels. "ratio": depth / (depth + nucleus distance), 0 at the membrane and 1 at the nucleus. "share":
        share of the cytoplasm's area whose ratio is smaller. With a round nucleus in the middle of a round
        cell it is the share that a map of cell and nucleus has, (R² − r²) / (R² − R₁²) at radius r between
        the nucleus' radius R₁ and the cell's, R.

    Returns
    -------
    ndarray of shape (H, W) and dtype float
        NaN in the nucleus and outside the cell.

    Raises
    ------
    ParameterError
        The shapes differ, or there is no cytoplasm or no nucleus.

    See Also
    --------
    profile_signal : A signal that depends on it.

    Examples
    --------
    >>> import cytodisk as cd
    >>> cell = cd.simulate.cell_with_nucleus("centred", radius_px=30.0)
    >>> place = cd.simulate.between_nucleus_and_membrane(cell.mask, cell.nucleus, "nucleus distance")
    >>> float(place[cell.mask & ~cell.nucleus].min())  # a pixel centre beside the nucleus
    0.5
    """
    along = one_of("along", along, WAYS)
    mask, nucleus = np.asarray(mask, dtype=bool), np.asarray(nucleus, dtype=bool)
    if mask.ndim != 2 or mask.shape != nucleus.shape:
        raise ParameterError(
            f"mask and nucleus must be 2D and of one shape, got {mask.shape} and {nucleus.shape}: "
            "pass two masks of one image"
        )
    cytoplasm = mask & ~nucleus
    if not (cytoplasm.any() and (nucleus & mask).any()):
        raise ParameterError("the cell must have a nucleus and a cytoplasm, got one without: pass both masks")
    inward = depth(mask)[cytoplasm]
    outward = ndimage.distance_transform_edt(~nucleus)[cytoplasm] - 0.5
    ratio = inward / (inward + outward)
    place = np.full(mask.shape, np.nan)
    if along == "depth":
        place[cytoplasm] = inward
    elif along == "nucleus distance":
        place[cytoplasm] = outward
    elif along == "ratio":
        place[cytoplasm] = ratio
    else:
        place[cytoplasm] = (rankdata(ratio) - 0.5) / ratio.size
    return place
