"""Masks of cells drawn from a seed: neuron-like, smooth, spiky, migrating."""

import numpy as np

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.checks import number_between
from cytodisk.errors import ParameterError
from cytodisk.simulate.drawing import all_angles, dot, inside_radius, paint

_SMOOTH_MODES = 6
_TURN_PER_STEP = 0.35  # radians, standard deviation of a process's change of direction


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

    See Also
    --------
    random_smooth, random_spiky, migrating : Other cells.

    Examples
    --------
    >>> import cytodisk as cd
    >>> mask = cd.simulate.branching(0, soma_radius=8, processes=3, process_length=30)
    >>> cd.clean_mask(mask)[1].components
    1
    """
    number_between("soma_radius", soma_radius, 1)
    number_between("processes", processes, 0)
    number_between("process_length", process_length, 0)
    number_between("process_width", process_width, 1)
    number_between("branch_every", branch_every, 1)
    random = np.random.default_rng(seed)
    strokes = [dot(0.0, 0.0, soma_radius)]
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
    return paint(np.array(strokes), margin)


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

    See Also
    --------
    random_spiky, branching, migrating : Other cells.

    Examples
    --------
    >>> import cytodisk as cd
    >>> first, again = cd.simulate.random_smooth(1, radius=15), cd.simulate.random_smooth(1, radius=15)
    >>> bool((first == again).all())  # the seed decides
    True
    """
    number_between("radius", radius, 1)
    number_between("roughness", roughness, 0)
    if roughness > 1:
        raise ParameterError(f"roughness must be 0 to 1, got {roughness!r}: pass a smaller one")
    mode = np.arange(1, _SMOOTH_MODES + 1)
    coefficient = np.random.default_rng(seed).normal(size=(2, _SMOOTH_MODES)) / mode
    angle = all_angles()
    waves = coefficient[0] @ np.cos(np.outer(mode, angle)) + coefficient[1] @ np.sin(np.outer(mode, angle))
    return inside_radius(radius * np.exp(roughness * waves / waves.std()), margin)


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
        Length of the longest spike beyond the body's mean radius, in pixels, at least 0. The shortest has a
        quarter of it.
    spike_width : float
        Width of the widest spike, in pixels, at least 1; the narrowest is 1 px.
    margin : int
        Pixels of background on every side, at least 0.

    Returns
    -------
    ndarray of shape (H, W) and dtype bool
        One piece; spikes that meet may enclose holes.

    Raises
    ------
    ParameterError
        A number is out of its range.

    See Also
    --------
    random_smooth, branching, migrating : Other cells.

    Examples
    --------
    >>> import cytodisk as cd
    >>> mask = cd.simulate.random_spiky(0, radius=12, spikes=5, spike_length=15)
    >>> cd.clean_mask(mask)[1].components
    1
    """
    number_between("radius", radius, 1)
    number_between("spikes", spikes, 0)
    number_between("spike_length", spike_length, 0)
    number_between("spike_width", spike_width, 1)
    random = np.random.default_rng(seed)
    strokes = []
    for _ in range(4):
        y, x = random.normal(0.0, 0.15 * radius, 2).tolist()
        strokes.append(dot(y, x, radius * random.uniform(0.6, 1.0)))
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
    return paint(np.array(strokes), margin)


def migrating(seed: int = 0, *, size: float = 1.0, margin: int = 8) -> BoolArray:
    """Mask of a migrating cell: a broad ruffled lamellipodium towards +x and a thin bent tail towards -x.

    Parameters
    ----------
    seed : int
        The same seed gives the same cell.
    size : float
        1 gives about 15 000 pixels; lengths grow with it. At least 0.1.
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
    random_smooth, random_spiky, branching : Other cells.
    movie : A cell that moves.

    Examples
    --------
    >>> import cytodisk as cd
    >>> mask = cd.simulate.migrating(0, size=0.3)
    >>> cd.map_to_disk(mask).certificate.valid
    True
    """
    number_between("size", size, 0.1)
    number_between("margin", margin, 0)
    random = np.random.default_rng(seed)
    strokes = np.concatenate([_fan(random), _tail(random)])
    return paint(size * strokes, margin)


def _fan(random: np.random.Generator) -> FloatArray:
    """Spokes of a body that is wide at its front, where its edge is ruffled."""
    angle = np.linspace(-np.pi, np.pi, 720, endpoint=False)
    front = np.exp(-((angle / 1.3) ** 4))
    mode = np.arange(4, 15)
    ruffles = random.normal(size=mode.size) / np.sqrt(mode) @ np.cos(np.outer(mode, angle) + mode[:, None])
    reach = 55.2 + 26.0 * front + 2.5 * front * ruffles
    nothing = np.zeros_like(angle)
    return np.column_stack([nothing, nothing, reach * np.sin(angle), reach * np.cos(angle), nothing + 1.0])


def _tail(random: np.random.Generator) -> FloatArray:
    """A bent process towards -x that narrows to 4 px."""
    along = np.linspace(-30.0, -125.0, 40)
    across = random.choice([-1.0, 1.0]) * random.uniform(5.0, 14.0) * np.sin((along + 30.0) / 40.0)
    half_width = 2.0 + 36.0 * np.exp((along + 30.0) / 16.0)
    knots = np.column_stack([across, along])
    return np.column_stack([knots[:-1], knots[1:], half_width[1:]])
