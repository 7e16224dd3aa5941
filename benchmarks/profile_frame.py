"""Where the time goes: stages of a warm `map_to_disk`, and of the whole path of a movie's frame.

Processor time with one thread, median over repetitions or frames. "example" is `map_to_disk` on that
reference mask; "melanoma" is the run of `cytodisk movie` on that movie with two channels and 10 × 60 windows,
from the reading of a frame to its rows on disk. A stage's time leaves out the stages inside it.

With `--page` the tables and the picture of the page "Where the time goes" are written, too; with `--py-spy` a
flame graph of the same run (needs py-spy).
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import tifffile

import cytodisk as cd
from cytodisk.plot.style import PAPER
from cytodisk.runs.movie.movie_inputs import open_movie
from cytodisk.runs.movie.movie_parameters import MovieParameters
from cytodisk.runs.movie.movie_study import movie_study
from pages import PAGES, machine_words, write_words
from reference_masks import data_folder
from speed import restart_with_one_thread
from stages import Stage, StageClock

_SYSTEMS = ("blocks:BlockSystem", "pressure_blocks:PressureSystem")
MAP_STAGES = (
    Stage(
        "outline",
        "clean mask",
        (
            "cytodisk.geometry.mask:FilledMask.of",
            "cytodisk.geometry.mask:FilledMask.under",
        ),
    ),
    Stage("outline", "trace", ("cytodisk.geometry.outline:trace_outline",)),
    Stage("mesh", "lattice", ("cytodisk.geometry.lattice:graded_lattice",)),
    Stage("mesh", "triangulation", ("cytodisk.geometry.triangulation:triangulated",)),
    Stage("mesh", "chords and checks", ("cytodisk.geometry.mesh:mesh_inside",)),
    Stage("map", "boundary angles", ("cytodisk.disk.circle:boundary_angles",)),
    Stage("map", "harmonic start", ("cytodisk.disk.harmonic:harmonic_map",)),
    Stage(
        "map",
        "previous frame as start",
        ("cytodisk.motion.temporal:carried_inside", "cytodisk.disk.untangle:untangled"),
    ),
    Stage("map", "order of elimination", ("cytodisk.disk.ldl:Factorisation.__init__",)),
    Stage("map", "pattern of the system", ("cytodisk.disk.blocks:BlockSystem.__init__",)),
    Stage(
        "map",
        "assembly",
        ("cytodisk.disk.newton:_Problem.__init__", "cytodisk.disk.newton:GaussNewton.gauss_newton_direction"),
    ),
    Stage("map", "factors", tuple(f"cytodisk.disk.{where}.factorise" for where in _SYSTEMS)),
    Stage("map", "solves", tuple(f"cytodisk.disk.{where}.solve" for where in _SYSTEMS)),
    Stage("map", "line search", ("cytodisk.disk.newton:GaussNewton.search",)),
    Stage("map", "certificate", ("cytodisk.disk.certificate:certify",)),
    Stage("map", "the rest of it", ("cytodisk.disk.mapping:map_mesh",)),
)
FRAME_STAGES = (
    Stage("files", "read", ("cytodisk.images.frame_file:FrameFile.frame",)),
    *MAP_STAGES,
    Stage("tracking", "registration", ("cytodisk.motion.registration:register",)),
    Stage("tracking", "matching and the rest", ("cytodisk.motion.tracking:follow",)),
    Stage("tracking", "angles", ("cytodisk.motion.temporal:tracked_angles",)),
    Stage("windows", "where parts of pixels lie", ("cytodisk.disk.disk_map:DiskMap.to_disk",)),
    Stage("windows", "weights", ("cytodisk.windows.weights:window_shares",)),
    Stage("sampling", "two channels", ("cytodisk.windows.sample:sampled_pixels",)),
    Stage("sampling", "depth of windows", ("cytodisk.windows.depths:window_depths",)),
    Stage("sampling", "size of windows", ("cytodisk.windows.window_sizes:window_sizes",)),
    Stage("measures", "edge motion", ("cytodisk.motion.edge:edge_motion",)),
    Stage("measures", "distortion", ("cytodisk.disk.distortion:distortion_of",)),
    Stage("measures", "rows", ("cytodisk.runs.movie.measured_frame:measure_frame",)),
    Stage("files", "map", ("cytodisk.motion.frame_file:save_frame",)),
    Stage(
        "files",
        "tables",
        ("cytodisk.store.study_parts:StudyParts.add", "cytodisk.store.study_parts:StudyParts.add_table"),
    ),
)
COUNTED = ("outline", "mesh", "map", "tracking", "windows", "sampling")
LIMITS_MS = {"example": 60.0, "melanoma": 120.0}
MOVIE = "melanoma_vasp_lpd/mask.tif", "melanoma_vasp_lpd/signal.ome.tif"
FILES = PAGES / "where_time_goes"
_FIRST_LAPS = 3  # of a movie: kernels are loaded, and the first frame follows none


@dataclass(frozen=True)
class Profile:
    """What one run came to.

    Attributes
    ----------
    name : str
    clock : StageClock
    steps : float
        Newton steps, median.
    """

    name: str
    clock: StageClock
    steps: float

    @property
    def counted_ms(self) -> float:
        """Median time of the parts that the yardstick counts: for "example" all of it."""
        if self.name == "example":
            return 1e3 * self.clock.medians()[0]
        keys = [stage.key for stage in self.clock.stages if stage.part in COUNTED]
        return 1e3 * float(np.median([sum(lap.by_stage[key] for key in keys) for lap in self.clock.laps]))

    def table(self) -> pd.DataFrame:
        """A row a stage in the order of the work, then the rest and the whole."""
        whole, seconds, calls = self.clock.medians()
        rows: list[dict[str, Any]] = [
            {"part": s.part, "stage": s.name, "ms": 1e3 * seconds[s.key], "calls": calls[s.key]}
            for s in self.clock.stages
        ]
        rest = float(np.median([lap.rest for lap in self.clock.laps]))
        rows.append({"part": "rest", "stage": "in no stage", "ms": 1e3 * rest, "calls": 1.0})
        rows.append({"part": "all", "stage": "", "ms": 1e3 * whole, "calls": 1.0})
        table = pd.DataFrame(rows)
        table.insert(3, "share", table["ms"] / (1e3 * whole))
        return table

    def verdict(self) -> str:
        """The yardstick's figure in a sentence."""
        limit = LIMITS_MS[self.name]
        what = "all stages" if self.name == "example" else ", ".join(COUNTED)
        met = "met" if self.counted_ms <= limit else "not met"
        return (
            f"{self.name}: {what} take {self.counted_ms:.0f} ms (at most {limit:.0f} ms: {met}), "
            f"{self.steps:.0f} Newton steps, median of {len(self.clock.laps)}"
        )


def profile_example(data: Path, repeats: int) -> Profile:
    """Stages of `map_to_disk` on the mask "example", warm."""
    mask = tifffile.imread(data / "reference_masks" / "example.tif") > 0
    steps = float(cd.map_to_disk(mask).steps)
    clock = StageClock(MAP_STAGES)
    with clock.watching():
        for _ in range(repeats):
            cd.map_to_disk(mask)
            clock.lap()
    return Profile("example", clock, steps)


def profile_movie(data: Path) -> Profile:
    """Stages of each frame of the melanoma movie, from the file to the rows on disk."""
    masks, signal = (data / name for name in MOVIE)
    inputs = open_movie(masks, signal, MovieParameters(layers=10, sectors=60))
    clock = StageClock(FRAME_STAGES)
    with tempfile.TemporaryDirectory() as out, clock.watching():
        study = movie_study(inputs, Path(out) / "study", progress=lambda done, total: clock.lap())
        steps = float(study.cells["steps"].median())
    del clock.laps[:_FIRST_LAPS]
    return Profile("melanoma", clock, steps)


def print_profile(profile: Profile) -> None:
    """Print a table."""
    print(f"\n{profile.name}\n{'part':<10}{'stage':<28}{'ms':>9}{'share':>8}{'calls':>7}")
    for row in profile.table().itertuples():
        print(f"{row.part:<10}{row.stage:<28}{row.ms:>9.2f}{row.share:>8.1%}{row.calls:>7.0f}")
    print(profile.verdict())
    for target in profile.clock.missing:
        print(f"NOT THERE at this revision, its time is in its caller's: {target}")


def write_page(profiles: list[Profile]) -> None:
    """Write tables and picture of the page."""
    FILES.mkdir(parents=True, exist_ok=True)
    for profile in profiles:
        table = profile.table().query("calls > 0").copy()
        table["ms"] = table["ms"].map("{:.1f}".format)
        table["share"] = table["share"].map("{:.1%}".format)
        table["calls"] = table["calls"].map("{:.0f}".format)
        table.to_csv(FILES / f"{profile.name}.csv", index=False)
    sentences = [f"* {profile.verdict()}." for profile in profiles]
    write_words(FILES / "measured.inc", [machine_words(), "", *sentences])
    draw(profiles).savefig(FILES / "stages.png", dpi=200)


def draw(profiles: list[Profile]) -> Any:
    """Bars of milliseconds by stage, coloured by part."""
    tables = [profile.table().query("part != 'all' and calls > 0") for profile in profiles]
    parts = list(dict.fromkeys(part for table in tables for part in table["part"]))
    colour = {part: plt.get_cmap("tab10")(number) for number, part in enumerate(parts)}
    with plt.rc_context(PAPER):
        figure, axes = plt.subplots(
            len(tables),
            figsize=(5.0, 0.55 + 0.145 * sum(map(len, tables))),
            height_ratios=[len(table) for table in tables],
            layout="constrained",
        )
        for ax, table, profile in zip(np.atleast_1d(axes), tables, profiles, strict=True):
            names = [f"{row.part}: {row.stage}" for row in table.itertuples()]
            ax.barh(names, table["ms"], color=[colour[part] for part in table["part"]])
            ax.margins(y=0.01)
            ax.invert_yaxis()
            ax.set_xlabel("processor time (ms)")
            ax.set_title(f"{profile.name}: {1e3 * profile.clock.medians()[0]:.0f} ms in all")
    return figure


def main() -> int:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--data", type=Path, default=data_folder())
    parser.add_argument("--repeats", type=int, default=25, help="of map_to_disk (default 25)")
    parser.add_argument("--only", choices=tuple(LIMITS_MS))
    parser.add_argument("--json", type=Path, help="write the tables to this file")
    parser.add_argument("--page", action="store_true", help="write tables and picture of the docs page")
    parser.add_argument("--py-spy", type=Path, metavar="SVG", help="write a flame graph instead")
    chosen = parser.parse_args()
    restart_with_one_thread()
    if not (chosen.data / "reference_masks").is_dir():
        parser.error(f"{chosen.data} has no reference_masks: set CYTODISK_DATA or pass --data")
    if chosen.page and chosen.only:
        parser.error("--page needs both profiles: leave out --only")
    if chosen.py_spy:
        again = [sys.executable, __file__, "--data", str(chosen.data), "--repeats", str(chosen.repeats)]
        again += ["--only", chosen.only] if chosen.only else []
        spy = [str(Path(sys.executable).with_name("py-spy")), "record", "-r", "500", "-o", str(chosen.py_spy)]
        return subprocess.run([*spy, "--", *again], env=os.environ, check=False).returncode
    profiles = []
    if chosen.only in (None, "example"):
        profiles.append(profile_example(chosen.data, chosen.repeats))
    if chosen.only in (None, "melanoma"):
        profiles.append(profile_movie(chosen.data))
    for profile in profiles:
        print_profile(profile)
    if chosen.json:
        figures = {p.name: {"ms": p.counted_ms, "stages": p.table().to_dict("records")} for p in profiles}
        chosen.json.write_text(json.dumps(figures, indent=1), encoding="utf-8")
    if chosen.page:
        write_page(profiles)
    return 0


if __name__ == "__main__":
    sys.exit(main())
