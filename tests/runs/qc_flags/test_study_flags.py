"""Each rule against a study with that fault alone."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from cytodisk.runs.qc_flags.column_flags import LARGEST_DISTORTION
from cytodisk.runs.qc_flags.qc_flag import QCFlag
from cytodisk.runs.qc_flags.study_flags import qc_flags
from cytodisk.store.study import Study

UNITS = {"length_unit": "µm", "velocity_unit": "µm/s", "pixel_size_um": 0.5, "frame_interval_s": 2.0}


class MadeStudy(Study):
    """A study whose tables are given."""

    def __init__(
        self, cells: pd.DataFrame, edge: pd.DataFrame, windows: pd.DataFrame, **more: object
    ) -> None:
        super().__init__(Path("made"), cells, {"run": "movie", **UNITS, **more})
        self.__dict__.update(edge=edge, windows=windows)


def made(frames: int = 20, n_cells: int = 1, **provenance: object) -> MadeStudy:
    """Cells without any fault: areas, velocities and signals that waver a little."""
    rng = np.random.default_rng(0)
    number, time = np.divmod(np.arange(n_cells * frames), frames)
    cells = pd.DataFrame({"cell": number, "frame": time, "label": number + 1, "status": "ok"})
    cells = cells.assign(reason="", mask_remarks="")
    cells = cells.assign(area=100 + rng.normal(0, 0.5, len(cells)), touches_border=False, border_share=0.0)
    cells["perimeter"] = np.sqrt(4 * np.pi * cells["area"])
    cells = cells.assign(
        nan_px=0, area_distortion=0.2, window_area_error=0.02, restarted="", tracking_residual=0.01
    )
    cells = cells.assign(interior_restarted="", smallest_window_share=np.nan)
    cells = cells.assign(order_violations=0, perimeter=20.0, swept_area=10.0)
    edge = cells[["cell", "frame"]].merge(pd.DataFrame({"sector": range(12)}), how="cross")
    edge["velocity"] = np.where(edge["frame"] == frames - 1, np.nan, rng.normal(0, 0.05, len(edge)))
    edge["protruded_area"] = edge["retracted_area"] = 1.0
    windows = cells[["cell", "frame"]].merge(pd.DataFrame({"channel": ["VASP", "actin"]}), how="cross")
    windows = windows.assign(mean=200 + rng.normal(0, 1, len(windows)), n_pixels=10.0)
    return MadeStudy(cells, edge, windows, **provenance)


def only(study: Study) -> QCFlag:
    (flag,) = qc_flags(study)
    return flag


def where(flag: QCFlag) -> list[tuple[int, int | None]]:
    return [(place.cell, place.frame) for place in flag.places]


def test_a_good_movie_has_none() -> None:
    assert qc_flags(made(n_cells=3)) == []


def test_scales_may_be_unknown() -> None:
    study = made(pixel_size_um=None, frame_interval_s=None, length_unit="px", velocity_unit="px/frame")
    assert qc_flags(study) == []


def test_an_edge_that_sweeps_more_than_the_cell_won_and_lost() -> None:
    study = made(n_cells=2)
    allowed = 1.25 * 24.0 + 0.1 * 0.5 * 20.0
    study.cells.loc[[3, 25], "swept_area"] = allowed + 0.01
    study.cells.loc[[7, 28], "swept_area"] = allowed - 0.01
    study.cells.loc[0, "swept_area"] = np.nan
    flag = only(study)
    assert flag.name == "edge mismatch"
    assert where(flag) == [(0, 3), (1, 5)]
    assert flag.places[0].note == "31 µm² swept"


@pytest.mark.parametrize(
    ("column", "value", "name", "note"),
    [
        ("mask_remarks", "a large fragment was dropped", "flagged masks", "a large fragment was dropped"),
        ("restarted", "the cell jumped", "tracking restarts", "the cell jumped"),
        ("interior_restarted", "the edge leapt", "interior restarts", "the edge leapt"),
        ("smallest_window_share", 0.09, "small still windows", "9 % of its usual area"),
        ("tracking_residual", 0.6, "tracking residual", "0.6 µm"),
        ("order_violations", 3, "order violations", "3 points"),
        ("window_area_error", 0.3, "strong distortion", "30%"),
        ("nan_px", 7, "NaN pixels", "7 px"),
    ],
)
def test_a_fault_in_two_frames(column: str, value: object, name: str, note: str) -> None:
    study = made(n_cells=2)
    study.cells.loc[[4, 25], column] = value
    flag = only(study)
    assert flag.name == name
    assert where(flag) == [(0, 4), (1, 5)]
    assert {place.note for place in flag.places} == {note}
    assert "2 frames" in flag.what
    assert flag.meaning
    assert flag.advice


@pytest.mark.parametrize(
    ("column", "value"), [("tracking_residual", 0.499), ("window_area_error", LARGEST_DISTORTION)]
)
def test_what_stays_below_its_threshold(column: str, value: float) -> None:
    study = made()
    study.cells.loc[4, column] = value
    assert qc_flags(study) == []


def test_border() -> None:
    study = made()
    study.cells["touches_border"] = study.cells["touches_border"].astype(object)
    study.cells.loc[3, ["touches_border", "border_share"]] = [True, 0.125]
    flag = only(study)
    assert (flag.name, where(flag), flag.places[0].note) == ("image border", [(0, 3)], "12% of the edge")


@pytest.mark.parametrize("status", ["refused", "missing", "unreadable"])
def test_frames_without_a_map(status: str) -> None:
    study = made()
    study.cells.loc[7, ["status", "reason"]] = [status, "the mask is empty"]
    study.cells.loc[7, ["area", "tracking_residual", "nan_px", "border_share"]] = np.nan
    study.cells["touches_border"] = study.cells["touches_border"].astype(object)
    study.cells.loc[7, ["restarted", "mask_remarks", "touches_border"]] = None
    flag = only(study)
    assert flag.name == f"{status} frames"
    assert flag.what == f"1 frame {status}"
    assert where(flag) == [(0, 7)]
    assert flag.places[0].note == "the mask is empty"


def test_area_jumps_are_those_beyond_the_cells_own() -> None:
    study = made(n_cells=2)
    cells = study.cells
    cells.loc[10:19, "area"] *= 1.2
    restless = 1.0 + 0.15 * np.sin(2.0 * np.pi * np.arange(20) / 6)  # steps up to 16 %, each like the next
    cells.loc[cells["cell"] == 1, "area"] *= restless
    flag = only(study)
    assert flag.name == "area jumps"
    assert where(flag) == [(0, 10)]
    assert flag.places[0].note in ("+19%", "+20%", "+21%")


def test_area_that_flickers() -> None:
    study = made()
    study.cells["area"] *= np.where(np.arange(20) % 2, 1.2, 1.0)
    flag = only(study)
    assert flag.name == "area jumps"
    assert where(flag) == [(0, frame) for frame in range(1, 20)]
    assert flag.what == (
        "the mask's area jumps in 19 frames; it flickers from frame to frame, "
        "by ±20% in 19 of 19 steps of cell 0"
    )


def test_a_change_of_area_across_a_gap_is_no_jump() -> None:
    study = made()
    study.cells.loc[10:, "area"] *= 1.2
    gap = study.cells.drop(index=10)
    assert qc_flags(MadeStudy(gap, study.edge, study.windows)) == []


def test_velocity_outliers() -> None:
    study = made()
    study.edge.loc[(study.edge["frame"] == 6) & (study.edge["sector"] == 9), "velocity"] = -2.0
    flag = only(study)
    assert (flag.name, where(flag)) == ("velocity outliers", [(0, 6)])
    assert flag.places[0].note == "up to −2 µm/s in sector 9"


def test_a_slow_edge_is_no_outlier() -> None:
    """Twenty times the spread, but a tenth of a pixel a frame."""
    study = made()
    study.edge["velocity"] *= 0.01
    study.edge.loc[5, "velocity"] = 0.03
    assert qc_flags(study) == []


def test_bleaching() -> None:
    study = made()
    fading = np.where(study.windows["channel"] == "VASP", 1 - 0.3 * study.windows["frame"] / 19, 1.0)
    study.windows["mean"] *= fading
    flag = only(study)
    assert flag.name == "signal drift"
    (place,) = flag.places
    assert (place.cell, place.frame) == (0, None)
    assert place.note in ("VASP −35% over the movie", "VASP −36% over the movie")


def test_an_edge_that_is_as_bright_as_before_around_a_cell_that_grows_is_no_drift() -> None:
    study = made()
    radius = 1 + 0.8 * study.cells["frame"] / 19
    study.cells["area"] *= radius**2
    study.cells["perimeter"] *= radius
    study.windows["mean"] /= 1 + 0.8 * study.windows["frame"] / 19
    assert qc_flags(study) == []
    study.windows["mean"] *= 1 - 0.4 * study.windows["frame"] / 19  # and fades
    assert only(study).name == "signal drift"


def test_warnings_that_no_other_flag_tells() -> None:
    study = made(warnings=["cell 0, frame 4: odd", "the disk is nearly full"])
    assert only(study).what == "2 warnings of the run: cell 0, frame 4: odd; the disk is nearly full"
    study.cells.loc[4, "mask_remarks"] = "odd"
    assert [flag.name for flag in qc_flags(study)] == ["flagged masks", "warnings"]
    assert qc_flags(study)[1].what == "1 warning of the run: the disk is nearly full"


def test_single_masks() -> None:
    cells = pd.DataFrame(
        {
            "cell": [0, 1, 2],
            "label": [1, 1, 1],
            "status": ["ok", "refused", "ok"],
            "reason": ["", "two cells", ""],
            "mask_remarks": ["", "", "mostly on the border"],
            "area_distortion": [0.01, np.nan, 0.5],
        }
    )
    study = MadeStudy(cells, pd.DataFrame(), pd.DataFrame(), run="map")
    flags = qc_flags(study)
    assert [(flag.name, where(flag)) for flag in flags] == [
        ("refused frames", [(1, None)]),
        ("flagged masks", [(2, None)]),
        ("strong distortion", [(2, None)]),
    ]
    assert flags[0].what == "1 cell refused"


@pytest.mark.parametrize(
    ("columns", "name", "note"),
    [
        ({"clipped_share": 0.75, "clipped_channel": "VASP"}, "clipped signal", "VASP: 75% of the cell"),
        (
            {"clipped_share": 0.96, "clipped_channel": "VASP", "clipped_note": "dim or cut off"},
            "clipped signal",
            "VASP: 96% of the cell; dim or cut off",
        ),
        (
            {"saturated_share": 0.034, "saturated_channel": "A"},
            "saturated signal",
            "A: 3.4% of the cell",
        ),
        ({"outline_step_px": 4}, "coarse outline", "steps of 4 px"),
    ],
)
def test_faults_of_what_came_in(columns: dict[str, object], name: str, note: str) -> None:
    study = made()
    fine = {"clipped_share": 0.1, "saturated_share": 0.01, "outline_step_px": 1}
    for column, value in (fine | {"clipped_channel": "", "saturated_channel": ""}).items():
        study.cells[column] = value
    assert qc_flags(study) == []
    for column, value in columns.items():
        study.cells.loc[[3, 4], column] = value
    flag = only(study)
    assert (flag.name, where(flag), flag.places[0].note) == (name, [(0, 3), (0, 4)], note)


@pytest.mark.parametrize(
    ("pixel_um", "wide", "command"),
    [
        (160.0, "3.61 mm", "--pixel-size 0.16"),
        (0.0001, "2.26 nm", "--pixel-size 0.1"),
        (0.02, "0.451 µm", "--pixel-size 20"),
    ],
)
def test_a_scale_that_makes_no_cell(pixel_um: float, wide: str, command: str) -> None:
    study = made(pixel_size_um=pixel_um)
    study.cells["area"] = 400.0 * pixel_um**2
    (flag,) = (flag for flag in qc_flags(study) if flag.name == "implausible scale")
    assert flag.what == f"cells are {wide} wide, with pixels of {pixel_um:.4g} µm"
    assert command in flag.advice
    assert "--pixel-size" in flag.advice
    assert flag.places == ()


def test_dirt_among_cells_says_nothing_of_the_scale() -> None:
    study = made(n_cells=3)
    study.cells.loc[study.cells["cell"] == 0, "area"] = 0.1
    assert "implausible scale" not in [flag.name for flag in qc_flags(study)]
