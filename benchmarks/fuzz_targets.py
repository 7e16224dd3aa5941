"""What can be damaged, how, and what is then done with it."""

import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import cytodisk as cd
from cytodisk.images.contents import contents
from cytodisk.images.frame_file import FileChoice
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
from cytodisk.runs.map.checked_cells import check_cells
from cytodisk.runs.movie.movie_inputs import open_movie
from cytodisk.runs.movie.movie_parameters import MovieParameters
from cytodisk.runs.parameters_file import parameters_from
from cytodisk.runs.qc_flags.study_flags import qc_flags
from cytodisk.store.activity_store import open_activity
from cytodisk.store.study import open_study
from fuzz_exports import FRAMES, MASKS, TRACKED
from fuzz_files import COMPARED, IMAGES, MAPPED, STUDY
from fuzz_mutants import (
    Mutation,
    of_array,
    of_bytes,
    of_fields,
    of_inner_xml,
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

    @property
    def alone(self) -> bool:
        """Whether the damaged file is used, rather than the folder that it is in."""
        return self.root == IMAGES


def _use_image(path: Path, _: Path, number: int) -> None:
    file = open_frames(path)
    for frame in range(min(file.n_frames, 3)):
        file.frame(frame)
    if number % 3 == 0:
        cd.read_image(path)
    if number % 3 == 1:
        load_image(file, 0)
    if number % 3 == 2:
        label = path.name in ("bits.png", "mask.png")  # of two cells
        list(check_cells(open_inputs(path, None, FileParameters(label=label))))
        if file.n_frames > 1:
            inputs = open_movie(path, None, MovieParameters(layers=2, sectors=6, label=label))
            for frame in range(2):
                inputs.masks.frame(frame)


def _use_outlines(path: Path, _: Path, number: int) -> None:
    """As masks of an image, which says how large they are."""
    signal = None if number % 2 else path.parent / "labels.tif"
    if path.name.startswith(("movie", "tracks")):
        inputs = open_movie(path, None, MovieParameters(layers=2, sectors=6, link=True))
        inputs.masks.frame(1)
    else:
        list(check_cells(open_inputs(path, signal, FileParameters())))


def _use_microscope(path: Path, _: Path, number: int) -> None:
    """As a signal, of which a scene, a slice and channels are chosen; and what `check` lists of it."""
    contents(path)
    stack, scenes = path.name.startswith("stack"), path.name.startswith("scenes")
    slices = [str(number % 3), "max", "mean"]
    choice = FileChoice(scene="1" if scenes else None, z=slices[number % 4 % 3] if stack else None)
    file = open_frames(path, choice=choice)
    for frame in range(min(file.n_frames, 3)):
        file.frame(frame)
    load_image(file, 0)
    if number % 3 == 0:
        cd.read_image(path, scene=choice.scene, z=choice.z)


def _use_tracks(path: Path, damaged: Path, _: int) -> None:
    tracks = (
        damaged if damaged.suffix == ".xml" else next(one for one in damaged.parents if one.suffix == ".geff")
    )
    open_movie(path / "labels.tif", None, MovieParameters(layers=2, sectors=6, tracks=str(tracks)))


def _use_folder(path: Path, damaged: Path, number: int) -> None:
    """With the damage, or another name or kind of the file that was damaged."""
    _disguise(damaged, number)
    if path.name == MASKS:
        list(check_cells(open_inputs(path / "masks", path / "signal", FileParameters())))
        return
    inputs = open_movie(path / "masks", path / "signal", MovieParameters(layers=2, sectors=6))
    for frame in range(inputs.masks.n_frames):
        inputs.masks.frame(frame)
        if inputs.signal is not None:
            load_image(inputs.signal, frame)


def _disguise(file: Path, number: int) -> None:
    """Another name or kind for a file of a folder, by the number of the mutant."""
    other = [
        "cell_t1.tif",
        "cell_t-1.tif",
        "cell_t99999999999999999999.tif",
        "cell_t2_c1.tif",
        f"{'t' * 250}.tif",
        "=cmd.tif",
        "[a]*.tif",
        "a\nb.tif",
        "cell_t\u0662.tif",
        ".cell.tif",
        "cell_t01.TIF",
        "cell_t01.png",
        "cell_t01",
    ]
    kind = number % 24
    if kind < len(other):
        file.rename(file.with_name(other[kind]))
        return
    content = file.read_bytes()
    match kind - len(other):
        case 0:
            file.unlink()
            file.mkdir()
        case 1:
            file.unlink()
            file.symlink_to(file)
        case 2:
            file.unlink()
            os.mkfifo(file)
        case 3:
            file.unlink()
            Path(os.fsdecode(os.fsencode(file.parent) + b"/cell_t\xff.tif")).write_bytes(content)
        case 4:
            file.unlink()
        case 5:
            for one in file.parent.iterdir():
                one.unlink()
        case 6:
            file.with_name(f"copy_{file.name}").write_bytes(content)


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


def _use_activity(path: Path, damaged: Path, number: int) -> None:
    open_activity(damaged, 0).load()  # beside the study, which looks whether the file is the run's own
    _use_study(path, damaged, number)


def _use_comparison(path: Path, _: Path, __: int) -> None:
    found = cd.open_comparison(path)
    found.summaries, repr(found)
    if found.cells.empty:
        return
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


_TIFF, _ZARR = (of_bytes, of_tiff, of_tiff), (of_json_or_bytes, of_json_or_bytes, of_bytes)
_SETTINGS = "correlation/*/settings.json"

TARGETS = (
    Target("TIFF", IMAGES, "*.tif", _TIFF, _use_image, 5.0),
    Target("PNG", IMAGES, "*.png", (of_bytes, of_png, of_png), _use_image, 2.0),
    Target("npy", IMAGES, "*.npy", (of_bytes, of_array), _use_image, 2.0),
    Target("GeoJSON", IMAGES, "*.geojson", (of_bytes, of_json, of_json), _use_outlines),
    Target("ROI", IMAGES, "*.roi", (of_bytes, of_fields, of_fields), _use_outlines),
    Target("ROI set", IMAGES, "*.zip", (of_bytes, of_zip(of_fields), of_zip(of_fields)), _use_outlines),
    Target("TrackMate outlines", IMAGES, "*.xml", (of_bytes, of_text, of_text), _use_outlines),
    Target("TrackMate tracks", TRACKED, "*.xml", (of_bytes, of_text, of_text), _use_tracks),
    Target("GEFF", TRACKED, "*.geff/**/*", (of_json_or_bytes, of_json_or_bytes, of_bytes), _use_tracks, 2.0),
    Target("CZI", IMAGES, "*.czi", (of_bytes, of_fields, of_fields, of_inner_xml), _use_microscope, 2.0),
    Target("LIF", IMAGES, "*.lif", (of_bytes, of_fields, of_inner_xml, of_inner_xml), _use_microscope, 2.0),
    Target("OME-Zarr", f"{IMAGES}/labels.ome.zarr", "**/*", _ZARR, _use_image, 2.0),
    Target("OME-Zarr 0.5", f"{IMAGES}/stack.ome.zarr", "**/*", _ZARR, _use_microscope, 2.0),
    Target("folder of frames", FRAMES, "*/*", (of_bytes, of_tiff), _use_folder, 2.0),
    Target("folder of masks", MASKS, "*/*", (of_bytes, of_tiff), _use_folder, 2.0),
    Target("map", STUDY, "maps/*.npz", (of_bytes, of_zip(of_array), of_zip(of_array)), _use_map, 4.0),
    Target("map of study", STUDY, "maps/*.npz", (of_zip(of_array),), _use_study, 2.0),
    Target("table", STUDY, "*.parquet", (of_bytes, of_parquet, of_parquet), _use_study, 3.0),
    Target("table of map", MAPPED, "*.parquet", (of_bytes, of_parquet), _use_study),
    Target("activity", STUDY, "activity.zarr.zip", (of_bytes, of_zip(of_json_or_bytes)), _use_activity, 3.0),
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
    Target("batch tables", "batch", "*.parquet", (of_bytes, of_parquet), _use_batch, 0.3),
    Target("batch provenance", "batch", "provenance.json", (of_bytes, of_json), _use_batch, 0.3),
)


def target_of(number: int, seed: int, kinds: Sequence[str] = ()) -> tuple[Target, Any]:
    """The kind of a mutant and its random numbers, from its number alone."""
    random = np.random.default_rng([seed, number])
    among = [target for target in TARGETS if not kinds or target.kind in kinds]
    weights = np.array([target.weight for target in among])
    return among[int(random.choice(len(among), p=weights / weights.sum()))], random
