"""The pages of waves: of a movie in which waves run around a cell, whole, in words, figures and tables."""

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import tifffile
from matplotlib.figure import Figure

import cytodisk as cd
from cytodisk.errors import ParameterError
from cytodisk.pages.waves.wave_files import write_wave_figures
from cytodisk.runs.findings.waves_finding import waves_finding

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> cd.Study:
    folder = tmp_path_factory.mktemp("waves")
    truth = cd.simulate.wave_movie("running", 3, frames=60, radius_px=16.0, direction=-1)
    masks, signal = folder / "masks.tif", folder / "signal.tif"
    tifffile.imwrite(masks, truth.masks.astype(np.uint8), photometric="minisblack")
    values = truth.signal.transpose("time", "channel", "y", "x").to_numpy()[:, 0]
    tifffile.imwrite(signal, values, photometric="minisblack", metadata={"axes": "TYX"})
    how: Any = {"frame_interval_s": truth.frame_interval_s, "pixel_size_um": truth.pixel_size_um}
    return cd.run_movie(masks, folder / "out", signal=signal, layers=3, sectors=16, channels=("Rac1",), **how)


def names(paths: list[Path]) -> list[str]:
    return [path.name for path in paths]


def test_waves_of_the_edge_from_the_movie_to_the_page(study: cd.Study, drawn: list[Figure]) -> None:
    found = cd.run_waves(study, surrogates=99)
    finding = waves_finding(study, found, 0)
    assert finding is not None
    assert finding.words.startswith("Waves run along the edge of cell 0: 1 wave around the cell, ")
    assert (
        "anticlockwise as seen in the image (towards lower sectors), period 100 s, p = 0.01" in finding.words
    )
    row = found.cells.iloc[0]
    assert row["speed"] == pytest.approx(-0.01, rel=0.1)
    edge = study.edge.groupby("frame")["edge_length"].sum(min_count=1).mean()
    assert row["speed_um_s"] == pytest.approx(-0.01 * edge, rel=0.1)
    steps: list[tuple[int, int]] = []
    paths = write_wave_figures(study, found, progress=lambda *step: steps.append(step))
    assert names(paths) == [f"cell_00000_{what}.png" for what in ("kymograph", "spectrum", "phase")]
    assert steps == [(done, 4) for done in range(5)]
    words = [text.get_text() for figure in drawn for text in figure.texts]
    assert any("anticlockwise as seen in the image" in one for one in words)
    assert set(names(paths)) <= {Path(name).name for name in cd.open_study(study.path).provenance["files"]}


def test_waves_of_a_signal_in_all_formats(study: cd.Study, drawn: list[Figure]) -> None:
    found = cd.run_waves(study, "Rac1", surrogates=19, layer=1, csv=True)
    assert pd.read_csv(found.path / "cells.csv")["layer"].tolist() == [1]
    paths = write_wave_figures(study, found, formats=("pdf", "svg"))
    assert {path.suffix for path in paths} == {".pdf", ".svg"}
    assert any("layer 1" in text.get_text() for text in drawn[0].texts)
    assert cd.open_study(study.path).wave_signals == [("Rac1",), ("velocity",)]


def test_an_edge_without_waves_has_no_crests(study: cd.Study, drawn: list[Figure]) -> None:
    found = cd.run_waves(study, "velocity_cell_frame", surrogates=19, frames=(0, 20))
    row = found.cells.iloc[0]
    assert row["kind"] == "none"
    assert names(write_wave_figures(study, found))[0] == "cell_00000_kymograph.png"
    assert "phase of the wave" not in [ax.get_title(loc="left") for ax in drawn[0].axes]
    with pytest.raises(ParameterError, match="cell 7 is not in"):
        write_wave_figures(study, found, cell=7)
