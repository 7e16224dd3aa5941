"""Masks of cells whose geometry is known, because they are drawn from a few numbers."""

from typing import Any

import numpy as np

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.errors import ParameterError

_SMOOTH_MODES = 6
_TURN_PER_STEP = 0.35  # radians, standard deviation of a process's change of direction


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
    """
    _at_least("radius", radius, 0.5)
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
    """
    if np.shape(semi_axes) != (2,):
        raise ParameterError(f"semi_axes must be two numbers (along y, along x), got {semi_axes!r}")
    _at_least("semi_axes", min(semi_axes), 0.5)
    _at_least("margin", margin, 0)
    turn = np.radians(angle)
    along_y, along_x = semi_axes
    half_height = np.hypot(along_y * np.cos(turn), along_x * np.sin(turn))
    half_width = np.hypot(along_y * np.sin(turn), along_x * np.cos(turn))
    y, x = _grid(half_height + margin, half_width + margin)
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
    """
    _at_least("arms", arms, 1)
    _at_least("body_radius", body_radius, 1)
    _at_least("arm_length", arm_length, 0)
    _at_least("arm_width", arm_width, 1)
    reach = body_radius + arm_length - 0.5 * arm_width
    angle = 2.0 * np.pi * np.arange(arms) / arms
    tips = reach * np.column_stack([np.sin(angle), np.cos(angle)])
    strokes = np.concatenate(
        [[_dot(0.0, 0.0, body_radius)], [(0.0, 0.0, *tip, 0.5 * arm_width) for tip in tips]]
    )
    return _paint(strokes, margin)


def dumbbell(
    radius: float = 40.0, *, neck_length: float = 20.0, neck_width: float = 3.0, margin: int = 8
) -> BoolArray:
    """Mask of two equal disks side by side, joined by a straight neck.

    Parameters
    ----------
    radius : float
        Of each disk, in pixels, at least 1.
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
    """
    _at_least("radius", radius, 1)
    _at_least("neck_length", neck_length, 0)
    _at_least("neck_width", neck_width, 1)
    away = radius + 0.5 * neck_length
    return _paint(
        np.array(
            [_dot(0.0, -away, radius), _dot(0.0, away, radius), (0.0, -away, 0.0, away, 0.5 * neck_width)]
        ),
        margin,
    )


def branching(
    seed: int = 0,
    *,
    soma_radius: float = 14.0,
    processes: int = 5,
    process_length: float = 90.0,
    process_width: float = 4.0,
    branch_every: float = 40.0,
    margin: int = 8,
) -> BoolArray:
    """Mask of a neuron-like cell: a soma with winding processes that fork and get thinner at every fork.

    Parameters
    ----------
    seed : int
        The same seed gives the same cell.
    soma_radius : float
        In pixels, at least 1.
    processes : int
        How many leave the soma, at least 0.
    process_length : float
        From the soma to each tip along the process, in pixels, at least 0.
    process_width : float
        At the soma, in pixels, at least 1; each fork narrows it by a quarter, to 1.5 px at least.
    branch_every : float
        Mean length between forks, in pixels, at least 1.
    margin : int
        Pixels of background on every side, at least 0.

    Returns
    -------
    ndarray of shape (H, W) and dtype bool
        One piece; processes that meet may enclose holes.

    Raises
    ------
    ParameterError
        A number is out of its range.
    """
    _at_least("soma_radius", soma_radius, 1)
    _at_least("processes", processes, 0)
    _at_least("process_length", process_length, 0)
    _at_least("process_width", process_width, 1)
    _at_least("branch_every", branch_every, 1)
    random = np.random.default_rng(seed)
    strokes = [_dot(0.0, 0.0, soma_radius)]
    first = random.uniform(0.0, 2.0 * np.pi)
    growing = [
        (0.0, 0.0, first + 2.0 * np.pi * k / processes, soma_radius + process_length, process_width)
        for k in range(processes)
    ]
    while growing:
        y, x, direction, left, width = growing.pop()
        step = min(4.0, left)
        end_y, end_x = y + step * np.sin(direction), x + step * np.cos(direction)
        strokes.append((y, x, end_y, end_x, 0.5 * width))
        if left <= 4.0:
            continue
        turn = random.normal(0.0, _TURN_PER_STEP)
        in_soma = np.hypot(end_y, end_x) < soma_radius
        if not in_soma and random.random() < step / branch_every:
            width, turn = max(0.75 * width, min(width, 1.5)), turn + 0.5
            growing.append((end_y, end_x, direction - 0.5, left - step, width))
        growing.append((end_y, end_x, direction + (0.0 if in_soma else turn), left - step, width))
    return _paint(np.array(strokes), margin)


def random_smooth(
    seed: int = 0, *, radius: float = 50.0, roughness: float = 0.25, margin: int = 8
) -> BoolArray:
    """Mask of a blob whose radius is a random trigonometric polynomial of the angle.

    Parameters
    ----------
    seed : int
        The same seed gives the same cell.
    radius : float
        Mean distance from the centre to the edge, in pixels, at least 1.
    roughness : float
        Standard deviation of the distance over its mean, 0 (a disk) to 1.
    margin : int
        Pixels of background on every side, at least 0.

    Returns
    -------
    ndarray of shape (H, W) and dtype bool

    Raises
    ------
    ParameterError
        A number is out of its range.
    """
    _at_least("radius", radius, 1)
    _at_least("roughness", roughness, 0)
    mode = np.arange(1, _SMOOTH_MODES + 1)
    coefficient = np.random.default_rng(seed).normal(size=(2, _SMOOTH_MODES)) / mode
    angle = _angles()
    waves = coefficient[0] @ np.cos(np.outer(mode, angle)) + coefficient[1] @ np.sin(np.outer(mode, angle))
    return _inside_radius(radius * np.exp(min(roughness, 1.0) * waves / waves.std()), margin)


def random_spiky(
    seed: int = 0,
    *,
    radius: float = 35.0,
    spikes: int = 12,
    spike_length: float = 40.0,
    spike_width: float = 4.0,
    margin: int = 8,
) -> BoolArray:
    """Mask of a blob with filopodium-like spikes of random place, direction and length.

    Parameters
    ----------
    seed : int
        The same seed gives the same cell.
    radius : float
        Mean radius of the body, in pixels, at least 1.
    spikes : int
        At least 0.
    spike_length : float
        Of the longest spike beyond the body's mean radius, in pixels, at least 0; the shortest is a quarter.
    spike_width : float
        Of the widest spike, in pixels, at least 1; the narrowest is 1 px.
    margin : int
        Pixels of background on every side, at least 0.

    Returns
    -------
    ndarray of shape (H, W) and dtype bool

    Raises
    ------
    ParameterError
        A number is out of its range.
    """
    _at_least("radius", radius, 1)
    _at_least("spikes", spikes, 0)
    _at_least("spike_length", spike_length, 0)
    _at_least("spike_width", spike_width, 1)
    random = np.random.default_rng(seed)
    strokes = [
        _dot(*random.normal(0.0, 0.15 * radius, 2), radius * random.uniform(0.6, 1.0)) for _ in range(4)
    ]
    for _ in range(spikes):
        direction = random.uniform(0.0, 2.0 * np.pi)
        away = radius + spike_length * random.uniform(0.25, 1.0)
        strokes.append(
            (
                0.0,
                0.0,
                away * np.sin(direction),
                away * np.cos(direction),
                0.5 * random.uniform(1.0, spike_width),
            )
        )
    return _paint(np.array(strokes), margin)


def _at_least(name: str, value: Any, least: float) -> None:
    if not (np.isscalar(value) and np.isreal(value) and least <= value < np.inf):
        raise ParameterError(f"{name} must be a number of at least {least}, got {value!r}: pass a larger one")


def _grid(half_height: float, half_width: float) -> tuple[FloatArray, FloatArray]:
    """Row and column of every pixel, counted from the central one."""
    rows, columns = int(np.floor(half_height + 1e-9)), int(np.floor(half_width + 1e-9))
    y, x = np.mgrid[-rows : rows + 1, -columns : columns + 1].astype(np.float64)
    return y, x


def _angles() -> FloatArray:
    return np.linspace(-np.pi, np.pi, 721)


def _inside_radius(radius_of_angle: FloatArray, margin: int) -> BoolArray:
    """Pixels nearer to the centre than a radius given at `_angles()`."""
    _at_least("margin", margin, 0)
    reach = radius_of_angle.max() + margin
    y, x = _grid(reach, reach)
    return np.asarray(np.hypot(y, x) <= np.interp(np.arctan2(y, x), _angles(), radius_of_angle))


def _dot(y: float, x: float, radius: float) -> tuple[float, float, float, float, float]:
    return y, x, y, x, radius


def _paint(strokes: FloatArray, margin: int) -> BoolArray:
    """Pixels within a stroke's half width of its segment; rows (y, x, end y, end x, half width).

    Pixel centres are at integers; the origin of the strokes is a pixel centre. Strokes are at least as wide
    as it takes to stay 8-connected.
    """
    _at_least("margin", margin, 0)
    half = np.maximum(strokes[:, 4], 0.5 * np.sqrt(2.0))
    points = np.concatenate([strokes[:, :2], strokes[:, 2:4]])
    reach = np.concatenate([half, half])[:, None]
    low = np.floor((points - reach).min(axis=0)).astype(int) - margin
    high = np.ceil((points + reach).max(axis=0)).astype(int) + margin
    mask = np.zeros(high - low + 1, dtype=bool)
    for (y, x, end_y, end_x, _), width in zip(strokes, half, strict=True):
        start = np.floor(np.minimum((y, x), (end_y, end_x)) - width).astype(int)
        stop = np.ceil(np.maximum((y, x), (end_y, end_x)) + width).astype(int) + 1
        row, column = np.mgrid[start[0] : stop[0], start[1] : stop[1]]
        window = mask[start[0] - low[0] : stop[0] - low[0], start[1] - low[1] : stop[1] - low[1]]
        window |= _distance_to_segment(row, column, (y, x), (end_y, end_x)) <= width + 1e-9
    return mask


def _distance_to_segment(
    row: Any, column: Any, start: tuple[float, float], stop: tuple[float, float]
) -> FloatArray:
    step_y, step_x = stop[0] - start[0], stop[1] - start[1]
    square = step_y**2 + step_x**2
    share = (
        ((row - start[0]) * step_y + (column - start[1]) * step_x) / square if square else np.zeros(row.shape)
    )
    share = np.clip(share, 0.0, 1.0)
    return np.asarray(np.hypot(row - start[0] - share * step_y, column - start[1] - share * step_x))
