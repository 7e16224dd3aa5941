"""What can be damaged, how, and what is then done with it."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import cytodisk as cd
from cytodisk.images.frames import open_frames
from cytodisk.images.signal_files import load_image
from cytodisk.motion.frame_file import load_boundary
from cytodisk.pages.report.page import write_report
from cytodisk.runs.batch.batch_file import read_batch
from cytodisk.runs.batch.batch_study import batch_study
from cytodisk.runs.batch.dry_run import understand
from cytodisk.runs.cells.cell_inputs import open_inputs
from cytodisk.runs.cells.cell_parameters import FileParameters
from cytodisk.runs.correlate.correlate_study import correlate_study
from cytodisk.runs.map.map_study import check_cells
from cytodisk.runs.movie.movie_inputs import open_movie
from cytodisk.runs.movie.movie_parameters import MovieParameters
from cytodisk.runs.parameters_file import parameters_from
from cytodisk.runs.qc_flags.study_flags import qc_flags
from cytodisk.store.study import open_study
from fuzz_files import COMPARED, IMAGES, MAPPED, STUDY
from fuzz_mutants import (
    Mutation,
    of_array,
    of_bytes,
    of_json,
    of_json_or_bytes,
    of_parquet,
    of_png,
    of_table_text,
    of_text,
    of_tiff,
    of_zip,
)

Use = Callable[[Path, Path, int], None]
"""Called with the copy of the folder or file, the damaged file in it, and the number of the mutant."""


@dataclass(frozen=True)
class Target:
    """A kind of files.

    Attributes
    ----------
    kind : str
    root : str
        What is copied for each mutant, relative to the folder of good files.
    pattern : str
        Files in it that are damaged; "" for itself.
    mutations : sequence of Mutation
    use : Use
    weight : float
        Its share of the mutants.
    """

    kind: str
    root: str
    pattern: str
    mutations: Sequence[Mutation]
    use: Use
    weight: float = 1.0


def _use_image(path: Path, _: Path, number: int) -> None:
    file = open_frames(path)
    for frame in range(min(file.n_frames, 3)):
        file.frame(frame)
    list(check_cells(open_inputs(path, None, FileParameters())))
    if number % 3 == 0:
        cd.read_image(path)
    if number % 3 == 1:
        inputs = open_movie(path, None, MovieParameters(layers=2, sectors=6))
        for frame in range(2):
            inputs.masks.frame(frame)
    if number % 3 == 2:
        load_image(file, 0)


def _use_map(path: Path, damaged: Path, _: int) -> None:
    disk = cd.load_map(damaged)
    disk.to_cell(disk.to_disk(np.argwhere(disk.placed_mask.box)[:50] + disk.placed_mask.corner))
    disk.certificate, disk.distortion  # noqa: B018  computed here
    windows = cd.polar_windows(2, 6).on(disk)
    windows.areas  # noqa: B018
    if "_t" in damaged.name:
        boundary = load_boundary(damaged, disk)
        boundary.normals_yx, boundary.lengths_px  # noqa: B018


def _use_study(path: Path, _: Path, number: int) -> None:
    study = open_study(path)
    repr(study), study.scale, study.windows
    cell = int(study.cells["cell"].iloc[0])
    if not study.is_movie:
        study.map(cell).certificate  # noqa: B018
        qc_flags(study)
        return
    study.edge, study.consistency  # noqa: B018
    study.activity(cell).load()
    movie = study.movie(cell)
    movie.points_yx, movie.on_border  # noqa: B018
    movie[len(movie) - 1].certificate  # noqa: B018
    for names in study.correlations:
        found = study.correlation(*names)
        for table in ("cells", "windows", "layers", "clusters", "curves", "layer_curves", "pairs", "events"):
            getattr(found, table)
        found.event_averages  # noqa: B018
    qc_flags(study)
    if number % 3 == 0:
        channel = str(study.activity(cell)["channel"].values[0])
        correlate_study(study, channel, surrogates=0, min_pairs=5, max_lag=2, clusters=False)
    if number % 5 == 0:
        write_report(study, path / "page.html")


def _use_comparison(path: Path, _: Path, __: int) -> None:
    found = cd.open_comparison(path)
    found.summaries, repr(found)
    found.labels(int(found.cells["cell"].iloc[0]))


def _use_parameters(path: Path, _: Path, __: int) -> None:
    parameters_from({}, path, MovieParameters)


def _use_batch_file(path: Path, _: Path, __: int) -> None:
    for item in read_batch(path / "batch.toml").inputs[:3]:
        understand(item)


def _use_batch(path: Path, _: Path, __: int) -> None:
    batch_study(
        read_batch(path.parent / "batch.toml"), path, resume=True, tell=lambda _: None, time_limit=15.0
    )


def _use_resumed(path: Path, _: Path, __: int) -> None:
    folder = path.parent
    cd.run_map(folder / "labels.tif", path, layers=2, sectors=6, resume=True)


_TIFF, _PLAIN = (of_bytes, of_tiff, of_tiff), (of_bytes,)
_SETTINGS = "correlation/*/settings.json"

TARGETS = (
    Target("TIFF", IMAGES, "*.tif", _TIFF, _use_image, 5.0),
    Target("PNG", IMAGES, "*.png", (of_bytes, of_png, of_png), _use_image, 2.0),
    Target("npy", IMAGES, "*.npy", (of_bytes, of_array), _use_image, 2.0),
    Target("GeoJSON", IMAGES, "*.geojson", (of_bytes, of_json, of_json), _use_image),
    Target("ROI", IMAGES, "*.roi", _PLAIN, _use_image),
    Target("ROI set", IMAGES, "*.zip", (of_bytes, of_zip(of_bytes)), _use_image),
    Target("XML", IMAGES, "*.xml", (of_bytes, of_text, of_text), _use_image),
    Target(
        "OME-Zarr",
        f"{IMAGES}/labels.ome.zarr",
        "**/*",
        (of_json_or_bytes, of_json_or_bytes, of_bytes),
        _use_image,
        2.0,
    ),
    Target("map", STUDY, "maps/*.npz", (of_bytes, of_zip(of_array), of_zip(of_array)), _use_map, 4.0),
    Target("map of study", STUDY, "maps/*.npz", (of_zip(of_array),), _use_study, 2.0),
    Target("table", STUDY, "*.parquet", (of_bytes, of_parquet, of_parquet), _use_study, 3.0),
    Target("table of map", MAPPED, "*.parquet", (of_bytes, of_parquet), _use_study),
    Target("activity", STUDY, "activity.zarr.zip", (of_bytes, of_zip(of_json_or_bytes)), _use_study, 3.0),
    Target("correlation", STUDY, "correlation/*/*.parquet", (of_bytes, of_parquet), _use_study, 2.0),
    Target("settings", STUDY, _SETTINGS, (of_bytes, of_json, of_json), _use_study),
    Target("provenance", STUDY, "provenance.json", (of_bytes, of_json, of_json), _use_study, 2.0),
    Target("columns", STUDY, "columns.csv", (of_bytes, of_table_text), _use_study, 0.3),
    Target("comparison", COMPARED, "**/*.*", (of_bytes, of_json_or_bytes), _use_comparison),
    Target("comparison table", COMPARED, "*.parquet", (of_parquet,), _use_comparison),
    Target("comparison map", COMPARED, "maps/*.npz", (of_bytes, of_zip(of_array)), _use_comparison),
    Target("parameters", "parameters.toml", "", (of_bytes, of_text, of_text), _use_parameters, 2.0),
    Target("batch file", "", "batch.toml", (of_bytes, of_text, of_text), _use_batch_file, 2.0),
    Target("batch table", "", "inputs.csv", (of_bytes, of_table_text), _use_batch_file),
    Target("batch row", "batch", "rows/*.json", (of_bytes, of_json, of_json), _use_batch, 0.3),
    Target("batch provenance", "batch", "provenance.json", (of_bytes, of_json), _use_batch, 0.3),
)


def target_of(number: int, seed: int, kinds: Sequence[str] = ()) -> tuple[Target, Any]:
    """The kind of a mutant and its random numbers, from its number alone."""
    random = np.random.default_rng([seed, number])
    among = [target for target in TARGETS if not kinds or target.kind in kinds]
    weights = np.array([target.weight for target in among])
    return among[int(random.choice(len(among), p=weights / weights.sum()))], random
