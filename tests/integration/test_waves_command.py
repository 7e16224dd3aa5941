"""`cytodisk waves`, from files to the finding, tables and figures."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from command_line import Run, assert_refused, write

import cytodisk as cd

pytestmark = pytest.mark.slow
FEW = ("--surrogates", "39", "--max-mode", "3")


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Of a cell with waves that run anticlockwise, in a channel and along its edge."""
    folder = tmp_path_factory.mktemp("waves")
    shown = cd.simulate.wave_movie("running", 1, frames=40, radius_px=14.0, period_s=50.0, direction=-1)
    masks = write(folder / "masks.tif", shown.masks.astype(np.uint8), metadata={"axes": "TYX"})
    values = shown.signal.transpose("time", "channel", "y", "x").to_numpy()[:, 0]
    signal = write(folder / "signal.tif", values, metadata={"axes": "TYX"})
    scale: Any = {"pixel_size_um": shown.pixel_size_um, "frame_interval_s": shown.frame_interval_s}
    made = cd.run_movie(
        masks, folder / "out", signal=signal, channels=("Rac1",), layers=2, sectors=12, **scale
    )
    return made.path


def test_the_first_line_is_the_finding(run: Run, study: Path) -> None:
    code, said, _ = run("waves", study, *FEW, "--format", "svg,pdf")
    assert code == 0
    first = said.splitlines()[0]
    assert first.startswith("Waves run along the edge of cell 0: 1 wave around the cell, ")
    assert "anticlockwise as seen in the image (towards lower sectors), period 50 s, p = 0.025" in first
    assert said.splitlines()[-1].startswith("results: ")
    found = cd.open_study(study).waves()
    assert {path.suffix for path in (found.path / "figures").iterdir()} == {".svg", ".pdf"}
    code, said, _ = run("waves", study, "--surrogates", "19", "--figures", "0")
    assert "The earlier waves of velocity (--max-mode 3, --surrogates 39) were replaced" in said


def test_a_signal_is_looked_at_in_every_layer(run: Run, study: Path) -> None:
    code, said, _ = run("waves", study, "--signal", "Rac1", "--layer", "1", *FEW, "--figures", "0", "--csv")
    assert code == 0
    assert said.startswith("Waves of Rac1 run around in layer 1 of cell 0: 1 wave around the cell, ")
    assert "  layer 0 (outermost): rotating, 1 wave around the cell, " in said
    assert "All layers take part: crests run around together" in said
    folder = cd.open_study(study).waves("Rac1").path
    assert {path.stem for path in folder.glob("*.csv")} >= {"cells", "layers", "modes", "depths", "columns"}


def test_wrong_names_are_refused(run: Run, study: Path) -> None:
    assert_refused(run("waves", study, "--signal", "RhoA"), "'RhoA' is not in the study", "'Rac1'")
    assert_refused(run("waves", study, "--signal", "Rac1", "--layer", "7"), "layer 7", "it has 0:1")
    assert_refused(run("waves", study, "--surrogates", "5"), "--surrogates", "19")
    assert_refused(run("waves", study, "--frames", "0:6"), "cannot be looked for in any cell")


def test_results_are_removed_with_the_study_that_they_are_of(run: Run, study: Path) -> None:
    cd.run_waves(study, surrogates=19, name="gone")
    masks, signal = study.parent / "masks.tif", study.parent / "signal.tif"
    code, _, _ = run(
        "movie",
        masks,
        "--signal",
        signal,
        "-o",
        study,
        "--layers",
        "2",
        "--sectors",
        "12",
        "--overwrite",
        "-q",
    )
    assert code == 0
    assert not (study / "waves").exists()
    assert cd.open_study(study).wave_signals == []
