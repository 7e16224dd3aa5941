"""A region that is brighter after a drug: from masks, images and a table of groups to windows that differ."""

from pathlib import Path

import pytest

import cytodisk as cd

SECTORS = 12
TOWARDS = {10, 11, 0, 1}  # within 60 degrees of the region's direction


@pytest.mark.slow
@pytest.mark.parametrize("nuclei", [False, True])
def test_the_region_comes_back_where_it_is_and_in_its_channel(tmp_path: Path, nuclei: bool) -> None:
    made = cd.simulate.population_images(
        tmp_path / "made", 3, experiments=4, cells=5, effect=0.8, nuclei=nuclei
    )
    grid = {"layers": 4, "sectors": SECTORS, "maps": False}
    cd.run_map(made.masks, tmp_path / "maps", signal=made.images, nuclei=made.nuclei, **grid)
    found = cd.run_population(
        tmp_path / "maps",
        tmp_path / "atlas",
        groups=made.groups,
        compare=("control", "drug"),
        align="nucleus" if nuclei else "none",
    )
    clusters = found.clusters[found.clusters["p"] <= 0.05]
    assert clusters["channel"].unique().tolist() == ["Rac1"]
    assert (clusters["sign"] == 1).all()
    windows = found.windows[found.windows["cluster"].isin(clusters["cluster"])]
    outer = windows[windows["layer"] == 0]
    assert set(outer["sector"]) >= TOWARDS
    beside = {(sector + step) % SECTORS for sector in TOWARDS for step in (-1, 0, 1)}
    assert set(windows["sector"]) <= beside
    assert windows["layer"].max() <= 2  # down to a third of the depth, and one more
    mean = windows["difference"].mean()
    assert mean == pytest.approx(0.8 * 200.0, rel=0.4)
