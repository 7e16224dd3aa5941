"""From masks and images of a simulated cell to who predicts whom, and to waves: what went in comes out."""

from pathlib import Path
from typing import Any

import pytest

import cytodisk as cd
from cytodisk.simulate import DrivenMovie

CELL: dict[str, Any] = {"radius_px": 22.0, "edge_speed_px": 0.7, "frames": 60, "sectors": 18}


def study_of(movie: DrivenMovie, folder: Path, sectors: int) -> Path:
    masks, signal = movie.write(folder / "input")
    cd.run_movie(masks, folder / "out", signal=signal, layers=3, sectors=sectors)
    return folder / "out"


def link(found: Any, source: str, target: str) -> Any:
    links = found.links
    return links[(links.source == source) & (links.target == target) & (links.layer == 0)].iloc[0]


@pytest.mark.slow
def test_a_channel_that_predicts_the_edge_is_told_from_the_edge_that_predicts_it(tmp_path: Path) -> None:
    movie = cd.simulate.predicting_movie("white", 1, strength=0.6, **CELL)
    found = cd.run_predict(study_of(movie, tmp_path, 18), "source", "velocity", surrogates=99)
    forth, back = link(found, "source", "velocity"), link(found, "velocity", "source")
    assert forth.gain == pytest.approx(movie.truth["gain"], rel=0.3)
    assert forth.p == forth.p_partial == 0.01
    assert forth.effect > 0.0
    assert back.gain < 0.1 * forth.gain


@pytest.mark.slow
def test_with_a_common_driver_given_the_channel_predicts_the_edge_hardly_more(tmp_path: Path) -> None:
    """Windows measure the driver with some noise, so that a little is left."""
    movie = cd.simulate.predicting_movie("white", 2, coupling="common driver", strength=0.7, **CELL)
    study = study_of(movie, tmp_path, 18)
    pair = cd.run_predict(study, "source", "velocity", surrogates=99, geometry=False)
    alone = link(pair, "source", "velocity")
    network = cd.run_predict(study, surrogates=99, geometry=False)
    assert alone.p == 0.01
    assert link(network, "source", "velocity").gain < 0.25 * alone.gain
    for target in ("velocity", "source"):
        assert link(network, "driver", target).p == 0.01
        assert link(network, "driver", target).gain > alone.gain


@pytest.mark.slow
def test_a_wave_along_the_edge_has_its_kind_speed_and_direction(tmp_path: Path) -> None:
    wave: dict[str, Any] = {"mode": 2, "direction": -1, "period_s": 75.0, "noise": 1.0}
    movie = cd.simulate.wave_movie("running", 3, **wave, **CELL)
    found = cd.run_waves(study_of(movie, tmp_path, 18), geometry=False).cells.iloc[0]
    assert found.kind == "rotating"
    assert found.p < 0.05
    assert found["mode"] == 2
    assert found.period_s == pytest.approx(75.0, rel=0.1)
    assert found.speed_um_s == pytest.approx(movie.truth["speed_um_s"], rel=0.1)
    assert found.direction < -0.8


@pytest.mark.slow
def test_a_wave_through_a_signal_runs_inwards_with_the_speed_that_was_put_in(tmp_path: Path) -> None:
    movie = cd.simulate.wave_movie("inward", 4, wavelength_um=4.0, contrast=0.4, **CELL)
    found = cd.run_waves(study_of(movie, tmp_path, 18), "wave", geometry=False).cells.iloc[0]
    assert found.inside == "inwards"
    assert found.inward_speed == pytest.approx(movie.truth["inward_speed_um_s"], rel=0.3)
