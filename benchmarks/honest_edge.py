"""Blocks of `honest.py` on the velocity of the edge: area, a thin protrusion, bias, and its error."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.geometry.locate import nearest_on_outline
from cytodisk.geometry.polygon import edge_lengths
from cytodisk.motion.disk_movie import DiskMovie
from cytodisk.motion.map_movie import map_movie
from cytodisk.motion.swept_edge import swept_edge
from cytodisk.motion.velocity import boundary_velocity, edge_changes
from cytodisk.simulate import MOVIE_KINDS, SimulatedMovie, flipped_masks, movie
from cytodisk.simulate.movie_kinds import MovieKind
from figure import Figure
from honest_trials import Trials, percent

SECTORS = 60
FEW_SECTORS, FEWEST_SECTORS = 12, 8
FILOPODIUM_FRAMES = 14
ALONG_X = 0.5  # degrees
BIASES: dict[str, tuple[MovieKind, dict[str, Any]]] = {
    "waves, k = 3, 6 px": ("waving", {}),
    "turning 5° a frame": ("turning", {"turn_deg": 5.0}),
    "turning 10° a frame": ("turning", {"turn_deg": 10.0}),
}
FAULTS: dict[str, dict[str, float]] = {
    "clean": {},
    **{f"flips of {share:g}": {"flips": share} for share in (0.05, 0.1, 0.2, 0.5)},
    **{
        f"edge noise 0.5 px over {length:g} px": {"jitter_px": 0.5, "jitter_length_px": length}
        for length in (1.5, 4.0, 8.0, 15.0, 30.0)
    },
    "edge noise 1 px over 8 px": {"jitter_px": 1.0, "jitter_length_px": 8.0},
    "clean, twice as fast": {"protrusion_px": 24.0},
    "clean, 12 sectors": {"sectors": FEW_SECTORS},
    "flips of 0.2, 12 sectors": {"flips": 0.2, "sectors": FEW_SECTORS},
    "flips of 0.2, 8 sectors": {"flips": 0.2, "sectors": FEWEST_SECTORS},
}
NOT_JUDGED = ("clean, twice as fast",)


def _steps(mapped: DiskMovie) -> Iterator[tuple[int, float]]:
    """Frames that have a map before and after, and Σ |swept area| until the next, in square pixels."""
    for number in range(len(mapped) - 1):
        here, there = (mapped.records[k].boundary for k in (number, number + 1))
        if here is not None and there is not None:
            yield number, swept_edge(here, there, "lab", mapped.image_shape).absolute_px2


def area_of_movie(job: tuple[MovieKind, int]) -> FloatArray:
    """|Σ velocity × length - (won - lost)| and Σ |swept area|, each over what is allowed, by frame."""
    kind, seed = job
    truth = movie(kind, seed, frames=25, signals=False)
    mapped = map_movie(truth.masks)
    changes = edge_changes(mapped, SECTORS)
    rows = []
    for frame, swept in _steps(mapped):
        now = changes.isel(time=frame)
        won, lost, length = (
            float(now[name].sum()) for name in ("protruded_area", "retracted_area", "edge_length")
        )
        flux = float((now["velocity"] * now["edge_length"]).sum())
        away = abs(flux - (won - lost)) / (0.05 * (won + lost) + 0.02 * length)
        rows.append([away, swept / (1.25 * (won + lost) + 0.1 * length)])
    return np.array(rows)


def area(trials: Trials) -> Iterator[Figure]:
    """Frames of each kind of movie whose velocity does not account for the area."""
    seeds = trials.seeds(3, 1)
    found = trials.run("area", area_of_movie, [(kind, seed) for kind in MOVIE_KINDS for seed in seeds])
    for number, kind in enumerate(MOVIE_KINDS):
        rows = np.concatenate(found[number * len(seeds) : (number + 1) * len(seeds)])
        worst = rows.max(axis=0)
        for column, what in enumerate(("Σ velocity × length", "Σ swept area")):
            yield Figure(
                f"{kind}: frames in which {what} is not what area says",
                int((rows[:, column] > 1.0).sum()),
                most=0,
                note=f"of {len(rows)}; at most {worst[column]:.2f} of what is allowed",
            )


def fastest_of_filopodium(job: tuple[int, float | None]) -> FloatArray:
    """Largest velocity_fastest in each frame, in px/frame."""
    seed, heading = job
    truth = movie(
        "filopodium",
        seed,
        frames=FILOPODIUM_FRAMES + 1,
        radius_px=35.0,
        heading_deg=heading,
        signals=False,
    )
    fastest = edge_changes(map_movie(truth.masks), SECTORS)["velocity_fastest"]
    return fastest.max("sector").to_numpy()[:FILOPODIUM_FRAMES]


def filopodium(trials: Trials) -> Iterator[Figure]:
    """The tip of a thin protrusion keeps its velocity, along the pixels and in any direction."""
    seeds = trials.seeds(12, 2)
    jobs = [(seeds[0], ALONG_X), *((seed, None) for seed in seeds)]
    found = np.array(trials.run("filopodium", fastest_of_filopodium, jobs))
    for rows, which in ((found[:1], "along x"), (found[1:], f"{len(seeds)} directions that were drawn")):
        first, middle, last = rows.min(axis=0)[[0, 7, 13]]
        yield Figure(
            f"{which}: smallest of all frames' fastest edge (true: 4)",
            float(rows.min()),
            "px/frame",
            least=3.5,
            note=f"mean {rows.mean():.2f}, largest {rows.max():.2f}; {(rows < 3.5).sum()} of {rows.size} "
            f"frames below 3.5; smallest in frames 0, 7, 13: {first:.2f}, {middle:.2f}, {last:.2f}",
        )


def biases_of_movie(job: tuple[str, int]) -> tuple[float, ...]:
    """Measured minus true mean velocity, by length of edge, sector, and tracked point, in px/frame."""
    kind, options = BIASES[job[0]]
    truth = movie(kind, job[1], frames=20, signals=False, **options)
    mapped = map_movie(truth.masks)
    changes = edge_changes(mapped, SECTORS).isel(time=slice(0, -1))
    lengths = np.array([edge_lengths(outline).sum() for outline in truth.boundary_yx])
    known = (
        np.nansum(truth.velocity_px[:-1] * _mean_lengths(truth)) / (lengths[1:] + lengths[:-1]).sum() * 2.0
    )
    velocity, length = changes["velocity"], changes["edge_length"]
    by_length = float((velocity * length).sum() / length.sum())
    by_point = float(boundary_velocity(mapped).mean())
    return by_length - known, float(velocity.mean()) - known, by_point - known


def _mean_lengths(truth: SimulatedMovie) -> FloatArray:
    lengths = np.stack([edge_lengths(outline) for outline in truth.boundary_yx])
    return 0.5 * (lengths[1:] + lengths[:-1])


def bias(trials: Trials) -> Iterator[Figure]:
    """Mean velocity where points slide along a curved edge."""
    seeds = trials.seeds(6, 2)
    found = trials.run("bias", biases_of_movie, [(name, seed) for name in BIASES for seed in seeds])
    for number, name in enumerate(BIASES):
        values = np.array(found[number * len(seeds) : (number + 1) * len(seeds)])
        for column, how in enumerate(("by length of edge", "by sector", "by tracked point")):
            worst = values[np.abs(values[:, column]).argmax(), column]
            yield Figure(
                f"{name}: bias of the mean velocity {how}",
                abs(values[:, column].mean()),
                "px/frame",
                most=0.01,
                note=f"{len(seeds)} movies, at most {worst:+.4f}",
            )


def scaled_errors(job: tuple[str, int]) -> FloatArray:
    """(measured - true) / velocity_error, and the deviation in px/frame; shape (2, frames × sectors)."""
    faults = dict(FAULTS[job[0]])
    flips, sectors = faults.pop("flips", 0.0), int(faults.pop("sectors", SECTORS))
    truth = movie("fluctuating", job[1], frames=40, signals=False, **faults)  # type: ignore[arg-type]
    masks: BoolArray = flipped_masks(truth.masks, flips, job[1]) if flips else truth.masks
    mapped = map_movie(masks)
    changes = edge_changes(mapped, sectors)
    away = changes["velocity"].to_numpy() - velocity_by_sector(truth, mapped, sectors)
    scaled = away / changes["velocity_error"].to_numpy()
    return np.stack([scaled[:-1].ravel(), away[:-1].ravel()])


def velocity_by_sector(truth: SimulatedMovie, mapped: DiskMovie, sectors: int = SECTORS) -> FloatArray:
    """True velocity of the pieces of edge that lie in each sector of the maps, shape (T, sectors).

    A piece lies at the mean of its angles in both frames, as a piece that is measured does.
    """
    found = np.full((len(truth.masks), sectors), np.nan)
    pieces = 0.5 * (truth.boundary_yx + np.roll(truth.boundary_yx, -1, axis=1))
    turns = [_turns_at(mapped[frame], points) for frame, points in enumerate(pieces)]
    for frame, length in enumerate(_mean_lengths(truth)):
        step = np.mod(turns[frame + 1] - turns[frame] + 0.5, 1.0) - 0.5
        sector = np.floor(np.mod(turns[frame] + 0.5 * step, 1.0) * sectors).astype(np.int64) % sectors
        total = np.bincount(sector, length, sectors)
        swept = np.bincount(sector, length * truth.velocity_px[frame], sectors)
        found[frame] = np.where(total > 0.0, swept / np.maximum(total, 1e-12), np.nan)
    return found


def _turns_at(disk: DiskMap, points_yx: FloatArray) -> FloatArray:
    """Angle on the disk, in turns, of the place of the outline nearest to each point."""
    outline_yx, outline_uv = disk.vertices_yx[disk.boundary], disk.vertices_uv[disk.boundary]
    edge, share = nearest_on_outline(points_yx, outline_yx)
    place = outline_uv[edge] + share[:, None] * (np.roll(outline_uv, -1, axis=0) - outline_uv)[edge]
    return np.asarray(np.arctan2(place[:, 1], place[:, 0]) / (2.0 * np.pi))


def error(trials: Trials) -> Iterator[Figure]:
    """Whether velocity_error is the size of the error, whatever the fault of the masks."""
    seeds = trials.seeds(4, 1)
    found = trials.run("error", scaled_errors, [(name, seed) for name in FAULTS for seed in seeds])
    for number, name in enumerate(FAULTS):
        scaled, away = np.concatenate(found[number * len(seeds) : (number + 1) * len(seeds)], axis=1)
        known = np.isfinite(scaled)
        by_movie = [
            float(np.nanstd(one[0])) for one in found[number * len(seeds) : (number + 1) * len(seeds)]
        ]
        within = percent(np.abs(scaled[known]) < 1.0)
        yield Figure(
            f"{name}: deviation of (measured - true) / error",
            float(scaled[known].std()),
            least=None if name in NOT_JUDGED else 0.7,
            most=None if name in NOT_JUDGED else 1.4,
            note=f"error is {np.median(away[known] / scaled[known]):.2f} px/frame in the median, true "
            f"deviation {away[known].std():.2f}; {within:.0f} % within one error; "
            f"from {min(by_movie):.2f} to {max(by_movie):.2f} in single movies",
        )
