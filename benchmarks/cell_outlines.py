"""Outlines of cells of every class, drawn anew at any size, turn and place on the pixel grid."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import shapely
import tifffile

from cytodisk import simulate
from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.errors import MaskError
from cytodisk.geometry.mask import clean_mask
from cytodisk.geometry.outline import trace_outline
from cytodisk.geometry.polygon import smooth_closed
from cytodisk.simulate.drawing import half_covered

MARGIN = 8.0
_OSTEOSARCOMA = (0, 8, 16, 24, 32, 40, 48, 56)  # of the first sixty


@dataclass(frozen=True)
class Shape:
    """A cell's outline, and what kind of cell it stands for.

    Attributes
    ----------
    name : str
    family : str
        Class of cells.
    outline_yx : ndarray of shape (N, 2) and dtype float
        (row, column) in pixels about the origin.
    """

    name: str
    family: str
    outline_yx: FloatArray

    @property
    def diameter(self) -> float:
        """Largest distance between two points of the outline, in pixels."""
        hull = self.outline_yx[_hull(self.outline_yx)]
        return float(np.hypot(*(hull[:, None] - hull[None]).T).max())

    def drawn(self, phase: Sequence[float], *, turn: float = 0.0, size: float = 1.0) -> "Drawing":
        """The shape on a pixel grid, turned by degrees from +x towards +y and enlarged.

        Its lowest row and column lie at `MARGIN` pixels and a phase from 0 to 1 for each.
        """
        matrix = size * rotation(turn)
        outline = self.outline_yx @ matrix.T
        corner = outline.min(axis=0) - MARGIN - np.asarray(phase)
        height, width = np.ceil(outline.max(axis=0) - corner + MARGIN).astype(int) + 1
        mask, _ = clean_mask(half_covered(outline - corner, (int(height), int(width))))
        return Drawing(mask, matrix, -corner)


@dataclass(frozen=True)
class Drawing:
    """A mask, and where it has each point of its shape: matrix @ point + offset."""

    mask: BoolArray
    matrix: FloatArray
    offset: FloatArray

    def places(self, shape_yx: FloatArray) -> FloatArray:
        """Pixels of points of the shape."""
        return shape_yx @ self.matrix.T + self.offset

    def shape_points(self, pixels_yx: FloatArray) -> FloatArray:
        """Points of the shape at pixels."""
        return np.linalg.solve(self.matrix, (pixels_yx - self.offset).T).T


def rotation(degrees: float) -> FloatArray:
    """Matrix that turns (y, x) from +x towards +y."""
    turn = np.radians(degrees)
    return np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])


def judges() -> list[Shape]:
    """The five shapes that the project's targets are set on: no default is chosen by them."""
    return [
        Shape("star", "star", polar(lambda t: 35.0 * (1.0 + 0.45 * np.cos(5 * t)))),
        Shape("L", "angular", corner_shape(70.0)),
        Shape("blob", "lobed", polar(blob(40.0, seed=1, amplitude=0.3))),
        Shape("comb", "comb", comb(teeth=6, tooth=7.0, gap=7.0, length=45.0, back=14.0)),
        Shape(
            "branched cell",
            "branched",
            branched(22.0, ((0.3, 60.0, 6.0), (2.0, 45.0, 5.0), (3.9, 55.0, 8.0), (5.1, 35.0, 5.0))),
        ),
    ]


def others() -> list[Shape]:
    """Shapes of every class that are not the judges, for choosing defaults."""
    drawn = [
        Shape("disk", "round", polar(lambda t: np.full_like(t, 40.0))),
        Shape("ellipse 2:1", "round", ellipse(50.0, 25.0)),
        Shape("ellipse 20:1", "elongated", ellipse(100.0, 5.0)),
        Shape(
            "dumbbell",
            "neck",
            strokes(
                ((0.0, -32.0, 0.0, -32.0, 52.0), (0.0, 32.0, 0.0, 32.0, 52.0), (0.0, -32.0, 0.0, 32.0, 7.0))
            ),
        ),
        Shape("spiral", "spiral", spiral(turns=2.0, pitch=22.0, width=10.0)),
        Shape("fishbone", "comb", fishbone(ribs=6, length=22.0, width=4.0)),
        Shape("comb of 4", "comb", comb(teeth=4, tooth=9.0, gap=10.0, length=36.0, back=18.0)),
        Shape("three arms", "star", polar(lambda t: 40.0 * (1.0 + 0.4 * np.cos(3 * t)))),
        Shape("star of 7", "star", polar(lambda t: 45.0 * (1.0 + 0.35 * np.cos(7 * t)))),
        Shape("blob 2", "lobed", polar(blob(50.0, seed=2, amplitude=0.25))),
        Shape("blob 3", "lobed", polar(blob(30.0, seed=3, amplitude=0.35))),
        Shape(
            "branched cell 2",
            "branched",
            branched(26.0, ((0.9, 50.0, 7.0), (2.8, 62.0, 6.0), (4.6, 40.0, 5.0))),
        ),
    ]
    simulated = {
        "amoeboid": ("lobed", simulate.migrating(seed=0)),
        "amoeboid 2": ("lobed", simulate.migrating(seed=3)),
        "spiky": ("spiky", simulate.random_spiky(0)),
        "spiky 2": ("spiky", simulate.random_spiky(4, radius=28.0, spikes=12, spike_length=25.0)),
        "neurite": ("branched", simulate.branching(2)),
    }
    return drawn + [Shape(name, family, outline_of(mask)) for name, (family, mask) in simulated.items()]


def real_cells(data: Path) -> list[Shape]:
    """Reference masks, and some of the first osteosarcoma cells that are in one piece."""
    references = {
        "example": "lobed",
        "disk60": "round",
        "ellipse5to1": "elongated",
        "star5": "star",
        "dumbbell3px": "neck",
        "neuron": "branched",
    }
    folder = data / "reference_masks"
    found = [
        Shape(f"reference {name}", family, outline_of(tifffile.imread(folder / f"{name}.tif") > 0))
        for name, family in references.items()
    ]
    return found + list(_osteosarcoma(data / "osteosarcoma" / "masks.tif"))


def _osteosarcoma(path: Path) -> Iterator[Shape]:
    for number in _OSTEOSARCOMA:
        try:
            mask, _ = clean_mask(tifffile.imread(path, key=number), fragments="error")
        except MaskError:
            continue
        yield Shape(f"osteosarcoma {number}", "osteosarcoma", outline_of(mask))


def outline_of(mask: BoolArray) -> FloatArray:
    """Outline of a mask without its pixel steps, about its middle."""
    outline = smooth_closed(trace_outline(clean_mask(np.pad(mask, 1))[0]), 1.0)
    return outline - 0.5 * (outline.min(axis=0) + outline.max(axis=0))


def polar(radius: Callable[[FloatArray], FloatArray], points: int = 1440) -> FloatArray:
    """Outline from its radius by angle, from +x towards +y."""
    angle = np.linspace(0.0, 2.0 * np.pi, points, endpoint=False)
    return radius(angle)[:, None] * np.column_stack([np.sin(angle), np.cos(angle)])


def blob(radius: float, seed: int, amplitude: float) -> Callable[[FloatArray], FloatArray]:
    """Radius of a lobed cell by angle: waves two to six, of random size and phase."""
    random = np.random.default_rng(seed)

    def by_angle(angle: FloatArray) -> FloatArray:
        waves = sum(
            random.normal() / k * np.cos(k * angle + random.uniform(0.0, 2.0 * np.pi)) for k in range(2, 7)
        )
        return np.asarray(radius * (1.0 + amplitude * waves / np.abs(waves).max()))

    return by_angle


def ellipse(along: float, across: float) -> FloatArray:
    """Ellipse with its long axis along x."""
    return polar(lambda t: along * across / np.hypot(across * np.cos(t), along * np.sin(t)), 2880)


def corner_shape(side: float) -> FloatArray:
    """Two bars of 0.4 of their length, joined at a right angle."""
    width = 0.4 * side
    yx = np.array([[0, 0], [0, side], [width, side], [width, width], [side, width], [side, 0]], dtype=float)
    return yx - 0.5 * side


def comb(teeth: int, tooth: float, gap: float, length: float, back: float) -> FloatArray:
    """Teeth on a back."""
    points = [(0.0, 0.0), (0.0, teeth * tooth + (teeth - 1) * gap)]
    for number in reversed(range(teeth)):
        start = number * (tooth + gap)
        points += [(back + length, start + tooth), (back + length, start)]
        points += [(back, start), (back, start - gap)] if number else []
    yx = np.array(points)
    return yx - 0.5 * yx.max(axis=0)


def fishbone(ribs: int, length: float, width: float) -> FloatArray:
    """A spine with ribs on both sides."""
    reach = 1.5 * width * (2 * ribs - 1)
    spine = (0.0, -reach, 0.0, reach, 2.0 * width)
    places = np.linspace(-reach, reach, ribs)
    return strokes((spine, *((-length, x, length, x, width) for x in places.tolist())))


def branched(body: float, arms: Sequence[tuple[float, float, float]]) -> FloatArray:
    """A round body with straight arms: angle from +x towards +y, length beyond the body, width."""
    ends = ((np.sin(angle), np.cos(angle), body + length, width) for angle, length, width in arms)
    return strokes(
        ((0.0, 0.0, 0.0, 0.0, 2.0 * body), *((0.0, 0.0, away * y, away * x, w) for y, x, away, w in ends))
    )


def spiral(turns: float, pitch: float, width: float) -> FloatArray:
    """A band of even width that winds about the origin."""
    angle = np.linspace(0.0, 2.0 * np.pi * turns, int(120 * turns))
    radius = pitch * (angle / (2.0 * np.pi) + 0.5)
    line = shapely.LineString(np.column_stack([radius * np.cos(angle), radius * np.sin(angle)]))
    return _outline(line.buffer(0.5 * width))


def strokes(segments: Sequence[tuple[float, float, float, float, float]]) -> FloatArray:
    """Outline of round-ended strokes that hang together: (y, x, end y, end x, width) each."""
    drawn = []
    for y, x, end_y, end_x, width in segments:
        there = (
            shapely.Point(x, y) if (y, x) == (end_y, end_x) else shapely.LineString([(x, y), (end_x, end_y)])
        )
        drawn.append(there.buffer(0.5 * width))
    return _outline(shapely.union_all(drawn))


def _outline(polygon: shapely.Polygon) -> FloatArray:
    return np.asarray(polygon.exterior.coords)[:-1, ::-1].copy()


def _hull(points: FloatArray) -> list[int]:
    from scipy.spatial import ConvexHull

    return ConvexHull(points).vertices.tolist()
