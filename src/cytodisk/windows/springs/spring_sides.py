"""Sides of windows as springs: where each of them crosses the borders between layers."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from cytodisk.arrays import BoolArray, FloatArray, IntArray
from cytodisk.windows.springs.closed_springs import relaxed_groups
from cytodisk.windows.springs.layer_borders import Border, inner_borders

_MET_PX = 0.5  # two sides of a window that come nearer than that on an inner border,
_MET_SHARE = 0.125  # and than this share of where they start in the layer, have met
_STRAIGHT_PX = 0.1
_ROUNDING = 1e-9


@dataclass(frozen=True, eq=False)
class Sides:
    """Sides of windows where they cross a border, in their order along it.

    Attributes
    ----------
    numbers : ndarray of shape (n,) and dtype int
        Side j is between windows j - 1 and j of the grid.
    places : ndarray of shape (n,) and dtype float
        Where they cross, in pixels along the border, not decreasing through one turn.
    joined : ndarray of shape (n,) and dtype bool
        Whether a side has met the one before it, so that no window is between them; not the first.
    """

    numbers: IntArray
    places: FloatArray
    joined: BoolArray

    @property
    def ranks(self) -> IntArray:
        """Number of each side if joined ones count as one, from 0."""
        return np.asarray(np.cumsum(~self.joined) - 1)

    @property
    def windows(self) -> IntArray:
        """Windows that are left, in their order: each is after the last of sides that are joined."""
        return np.asarray(self.numbers[np.append(~self.joined[1:], True)])


@dataclass(frozen=True, eq=False)
class CrossedBorder:
    """A border with the sides of windows that cross it.

    Attributes
    ----------
    border : Border
    sides : Sides
    inner : list of InnerBorder
        The next deeper ones within this one; filled in as they are found.
    """

    border: Border
    sides: Sides
    inner: list[InnerBorder] = field(default_factory=list)

    def windows_below(
        self, places_yx: FloatArray, arc: FloatArray, share: FloatArray, depth_px: float
    ) -> IntArray:
        """Sectors of places in the layer below.

        Parameters
        ----------
        places_yx : ndarray of shape (P, n, 2) and dtype float
            (row, column) in pixels.
        arc : ndarray of shape (P, n) and dtype float
            How far along this border the nearest point to each place is, in pixels.
        share : ndarray of shape (P, n) and dtype float
            How far each place is on the way through the layer, 0 to 1.
        depth_px : float
            Thickness of the layer.

        Returns
        -------
        ndarray of shape (P, n) and dtype int
        """
        windows = self.sides.windows
        here = self.rank_at(arc)
        beneath = self._rank_beneath(places_yx, arc, here, (1.0 - share) * depth_px)
        rank = here + share * (beneath - here)
        return np.asarray(windows[np.mod(np.floor(rank).astype(np.int64), len(windows))])

    def rank_at(self, arc: FloatArray) -> FloatArray:
        """Rank, as a number with fraction, at a distance along the border; whole at the sides."""
        ranks = np.append(self.sides.ranks, self.sides.ranks[-1] + 1)
        return interpolated(arc, self.sides.places, ranks, self.border.length)

    def _rank_beneath(
        self, places_yx: FloatArray, arc: FloatArray, here: FloatArray, left: FloatArray
    ) -> FloatArray:
        """Rank on the next deeper border, where the way leads to; that of here where there is none."""
        found, nearest = here.copy(), np.full(arc.shape, np.inf)
        count = len(self.sides.windows)
        for inner in self.inner:
            way, place = inner.down(arc)
            border = inner.crossed.border
            distance, straight_on = border.nearest(places_yx)
            straight = distance < left + _STRAIGHT_PX  # else the way meets another one before it gets there
            way, place = np.where(straight, 0.0, way), np.where(straight, straight_on, place)
            beneath = interpolated(place, inner.crossed.sides.places, inner.ranks, border.length)
            beneath += count * np.round((here - beneath) / count)
            nearer = way < nearest
            found[nearer], nearest[nearer] = beneath[nearer], way[nearer]
        return found


@dataclass(frozen=True, eq=False)
class InnerBorder:
    """A deeper border, and the ways from the one above it: straight, by the gradient of the distance.

    Attributes
    ----------
    crossed : CrossedBorder
    ranks : ndarray of shape (n + 1,) and dtype int
        Of its sides on the border above, and of the first again, a turn further on.
    feet : ndarray of shape (points + 1,) and dtype float
        From `Border.feet_of`.
    length : float
        Of the border above.
    """

    crossed: CrossedBorder
    ranks: IntArray
    feet: FloatArray
    length: float

    def down(self, arc: FloatArray) -> tuple[FloatArray, FloatArray]:
        """How far a place above is from the nearest way down, and where it comes to lie on this border."""
        return way_down(arc, self.feet, self.crossed.border.arc, self.length)


def interpolated(arc: FloatArray, places: FloatArray, values: IntArray, length: float) -> FloatArray:
    """Values along a closed curve between places on it.

    Parameters
    ----------
    arc : ndarray of shape (...) and dtype float
        Distances along the curve.
    places : ndarray of shape (n,) and dtype float
        Not decreasing through one turn.
    values : ndarray of shape (n + 1,) and dtype int
        At the places, and at the first one a turn later.
    length : float
        Of the curve.

    Returns
    -------
    ndarray of shape (...) and dtype float
    """
    within = places[0] + np.mod(arc - places[0], length)
    return np.asarray(np.interp(within, np.append(places, places[0] + length), values))


def way_down(
    arc: FloatArray, feet: FloatArray, inner_arc: FloatArray, length: float
) -> tuple[FloatArray, FloatArray]:
    """How far places on a border are from the nearest foot, and where on the inner border they belong.

    Parameters
    ----------
    arc : ndarray of shape (...) and dtype float
    feet, inner_arc : ndarray of shape (points + 1,) and dtype float
        Of each point of the inner border, along the outer and the inner one.
    length : float
        Of the outer border.

    Returns
    -------
    away, place : ndarray of shape (...) and dtype float
    """
    lifted = feet[0] + np.mod(arc - feet[0], length)
    after = np.clip(np.searchsorted(feet, lifted, side="right"), 1, len(feet) - 1)
    away = np.minimum(lifted - feet[after - 1], feet[after] - lifted)
    gap = feet[after] - feet[after - 1]
    share = np.divide(lifted - feet[after - 1], gap, out=np.zeros_like(gap), where=gap > 0)
    return away, inner_arc[after - 1] + share * (inner_arc[after] - inner_arc[after - 1])


def cross_borders(
    edge: CrossedBorder, depth_px: float, layers: int, evenness: float
) -> list[list[CrossedBorder]]:
    """Where the sides of windows cross the borders between layers, springs at rest.

    Parameters
    ----------
    edge : CrossedBorder
        The outline, and where sides start on it.
    depth_px : float
        Thickness of a layer.
    layers : int
    evenness : float
        Over how many windows springs even out their widths.

    Returns
    -------
    list of list of CrossedBorder
        By depth, the first is the outline alone; it ends where the cell does, after `layers` at the latest.
    """
    levels = [[edge]]
    for layer in range(1, layers):
        found = inner_borders(edge.border.points_yx, layer * depth_px)
        if not found:
            break
        below: list[CrossedBorder] = []
        for above in levels[-1]:
            own = [border for border in found if _is_within(border, above, levels[-1])]
            below += _cross_inner(above, own, evenness) if own else []
        levels.append(below)
    return levels


def _is_within(border: Border, above: CrossedBorder, others: list[CrossedBorder]) -> bool:
    """Whether a border lies within another one, which of all at its depth is then the nearest."""
    if len(others) == 1:
        return True
    place = border.points_yx[None, :1]
    return min(others, key=lambda other: float(other.border.nearest(place)[0].item())) is above


def _cross_inner(above: CrossedBorder, borders: list[Border], evenness: float) -> list[CrossedBorder]:
    """The borders within another one, with the sides that lead there."""
    length = above.border.length
    feet = [above.border.feet_of(border) for border in borders]
    ways = [
        way_down(above.sides.places, foot, border.arc, length)
        for border, foot in zip(borders, feet, strict=True)
    ]
    chosen = np.argmin([away for away, _ in ways], axis=0)
    ranks, count = above.sides.ranks, len(above.sides.windows)
    for number, (border, foot, (_, landing)) in enumerate(zip(borders, feet, ways, strict=True)):
        own = np.flatnonzero(chosen == number)
        order, sides = _at_rest(above, own, landing[own], border.length, evenness)
        if sides is None:  # all sides have met, or lead elsewhere: one window has it all
            middle = np.array([0.5 * (foot[0] + foot[-1])])
            rank = np.mod(np.floor(above.rank_at(middle)).astype(np.int64), count)
            sides = Sides(above.sides.windows[rank], np.zeros(1), np.zeros(1, dtype=bool))
            there = np.append(rank, rank + 1)
        else:
            steps = np.mod(np.diff(ranks[own][order], append=ranks[own][order][:1]), count)
            if not steps.any():
                steps[-1] = count
            there = ranks[own][order][0] + np.concatenate([[0], np.cumsum(steps)])
        above.inner.append(InnerBorder(CrossedBorder(border, sides), there, foot, length))
    return [inner.crossed for inner in above.inner]


def _at_rest(
    above: CrossedBorder, own: IntArray, landing: FloatArray, length: float, evenness: float
) -> tuple[IntArray, Sides | None]:
    """Order of sides along a border, and the sides, springs at rest; None where no window is left."""
    numbers, starts = above.sides.numbers[own], above.sides.places[own]
    widths = steps_along(landing, length)
    count = len(above.sides.windows)
    apart = np.mod(np.diff(above.sides.ranks[own], prepend=above.sides.ranks[own][-1:]), count) > 1
    met = (widths < _MET_PX) & (widths <= _MET_SHARE * steps_along(starts, above.border.length))
    joined: BoolArray = apart | met
    if joined.all():
        return own, None
    first = int(np.argmin(joined))
    order = np.roll(np.arange(len(own)), -first)
    lifted = landing[first] + np.concatenate([[0.0], np.cumsum(widths[order][1:])])
    places = relaxed_groups(lifted, joined[order], length, evenness**2)
    return order, Sides(numbers[order], places, joined[order])


def steps_along(places: FloatArray, length: float) -> FloatArray:
    """Distance along a closed curve from the place before to each place; rounding is no turn."""
    if len(places) == 1:
        return np.array([length])
    steps = np.mod(places - np.roll(places, 1), length)
    steps[steps > (1.0 - _ROUNDING) * length] = 0.0
    return np.asarray(steps)
