import pytest

import cytodisk as cd


@pytest.fixture(scope="session")
def cell() -> cd.DiskMap:
    """A migrating cell of about 2 000 pixels with a bent tail."""
    return cd.map_to_disk(cd.simulate.migrating(seed=3, size=0.4))


@pytest.fixture(scope="session")
def windows(cell: cd.DiskMap) -> cd.CellWindows:
    return cd.polar_windows(4, 12).on(cell)
