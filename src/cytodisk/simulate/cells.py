"""Masks of cells whose geometry is known, because they are drawn from a few numbers."""

import numpy as np

from cytodisk.arrays import BoolArray
from cytodisk.checks import number_between
from cytodisk.errors import ParameterError
from cytodisk.simulate.drawing import dot, paint, pixel_grid


def disk(radius: float = 60.0, margin: int = 8) -> BoolArray:
    """Mask of a disk: the pixels whose centre lies within a radius of the image's central pixel.

    Parameters
    ----------
    radius : float
        In pixels, at least 0.5.
    margin : int
        Pixels of background on every side, at least 0.

    Returns
    -------
    ndarray of shape (H, H) and dtype bool
        Its area is π radius² square pixels, up to the pixels at the edge.

    Raises
    ------
    ParameterError
        A number is out of its range.

    See Also
    --------
    ellipse, star, dumbbell : Other plain shapes.
    random_smooth : A cell with a smooth outline.

    Examples
    --------
    >>> import cytodisk as cd
    >>> mask = cd.simulate.disk(radius=10)
    >>> mask.shape, int(mask.sum())  # about 100 π pixels
    ((37, 37), 317)
    """
    number_between("radius", radius, 0.5)
    return ellipse((radius, radius), margin=margin)


def ellipse(
    semi_axes: tuple[float, float] = (20.0, 100.0), *, angle: float = 0.0, margin: int = 8
) -> BoolArray:
    """Mask of an ellipse about the image's central pixel.

    Parameters
    ----------
    semi_axes : (float, float)
        Along y and along x before turning, in pixels, each at least 0.5.
    angle : float
        In degrees, from +x towards +y.
    margin : int
        Pixels of background on every side, at least 0.

    Returns
    -------
    ndarray of shape (H, W) and dtype bool
        Its area is π times the product of the semi-axes, up to the pixels at the edge.

    Raises
    ------
    ParameterError
        A number is out of its range.

    See Also
    --------
    disk, star, dumbbell : Other plain shapes.

    Examples
    --------
    >>> import cytodisk as cd
    >>> mask = cd.simulate.ellipse((10, 20), angle=30.0)
    >>> int(mask.sum())  # about 200 π pixels
    633
    """
    if np.shape(semi_axes) != (2,):
        raise ParameterError(f"semi_axes must be two numbers (along y, along x), got {semi_axes!r}")
    number_between("semi_axes", min(semi_axes), 0.5)
    number_between("margin", margin, 0)
    turn = np.radians(angle)
    along_y, along_x = semi_axes
    half_height = np.hypot(along_y * np.cos(turn), along_x * np.sin(turn))
    half_width = np.hypot(along_y * np.sin(turn), along_x * np.cos(turn))
    y, x = pixel_grid(half_height + margin, half_width + margin)
    across, along = y * np.cos(turn) - x * np.sin(turn), x * np.cos(turn) + y * np.sin(turn)
    return np.asarray((across / along_y) ** 2 + (along / along_x) ** 2 <= 1.0 + 1e-12)


def star(
    arms: int = 5,
    *,
    body_radius: float = 35.0,
    arm_length: float = 60.0,
    arm_width: float = 8.0,
    margin: int = 8,
) -> BoolArray:
    """Mask of a round body with straight arms of even width and round tips, evenly spread.

    Parameters
    ----------
    arms : int
        At least 1; the first points along +x.
    body_radius : float
        In pixels, at least 1.
    arm_length : float
        From the body's edge to the tip, in pixels, at least 0.
    arm_width : float
        In pixels, at least 1.
    margin : int
        Pixels of background on every side, at least 0.

    Returns
    -------
    ndarray of shape (H, W) and dtype bool

    Raises
    ------
    ParameterError
        A number is out of its range.

    See Also
    --------
    disk, ellipse, dumbbell : Other plain shapes.
    random_spiky : Spikes of random length.

    Examples
    --------
    >>> import cytodisk as cd
    >>> mask = cd.simulate.star(arms=3, body_radius=12, arm_length=20)
    >>> cd.clean_mask(mask)[1].components
    1
    """
    number_between("arms", arms, 1)
    number_between("body_radius", body_radius, 1)
    number_between("arm_length", arm_length, 0)
    number_between("arm_width", arm_width, 1)
    reach = body_radius + arm_length - 0.5 * arm_width
    angle = 2.0 * np.pi * np.arange(arms) / arms
    tips = reach * np.column_stack([np.sin(angle), np.cos(angle)])
    strokes = np.concatenate(
        [[dot(0.0, 0.0, body_radius)], [(0.0, 0.0, *tip, 0.5 * arm_width) for tip in tips]]
    )
    return paint(strokes, margin)


def dumbbell(
    radius: float = 40.0, *, neck_length: float = 20.0, neck_width: float = 3.0, margin: int = 8
) -> BoolArray:
    """Mask of two equal disks side by side, joined by a straight neck.

    Parameters
    ----------
    radius : float
        Radius of each disk, in pixels, at least 1.
    neck_length : float
        Gap between the disks, in pixels, at least 0.
    neck_width : float
        In pixels, at least 1.
    margin : int
        Pixels of background on every side, at least 0.

    Returns
    -------
    ndarray of shape (H, W) and dtype bool

    Raises
    ------
    ParameterError
        A number is out of its range.

    See Also
    --------
    disk, ellipse, star : Other plain shapes.

    Examples
    --------
    >>> import cytodisk as cd
    >>> mask = cd.simulate.dumbbell(radius=12, neck_width=3)
    >>> cd.clean_mask(mask)[1].components  # the neck holds the two disks together
    1
    """
    number_between("radius", radius, 1)
    number_between("neck_length", neck_length, 0)
    number_between("neck_width", neck_width, 1)
    away = radius + 0.5 * neck_length
    return paint(
        np.array(
            [dot(0.0, -away, radius), dot(0.0, away, radius), (0.0, -away, 0.0, away, 0.5 * neck_width)]
        ),
        margin,
    )
