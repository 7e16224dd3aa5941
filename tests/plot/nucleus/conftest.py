import numpy as np
import pytest
import xarray as xr

from cytodisk.disk.disk_map import DiskMap
from cytodisk.disk.mapping import map_to_disk
from cytodisk.simulate.nuclei.cells_with_nuclei import CellWithNucleus, cell_with_nucleus
from cytodisk.simulate.nuclei.profile_signals import profile_signal
from cytodisk.windows.polar_windows import CellWindows, polar_windows
from cytodisk.windows.sample import sample


@pytest.fixture(scope="session")
def cell() -> CellWithNucleus:
    return cell_with_nucleus("off centre", seed=1, radius_px=24.0)


@pytest.fixture(scope="session")
def nucleus_disk(cell: CellWithNucleus) -> DiskMap:
    return map_to_disk(cell.mask, nucleus=cell.nucleus, pixel_size_um=0.5)


@pytest.fixture(scope="session")
def nucleus_windows(nucleus_disk: DiskMap) -> CellWindows:
    return polar_windows(layers=4, sectors=12, nucleus_layers=2).on(nucleus_disk)


@pytest.fixture(scope="session")
def sampled(cell: CellWithNucleus, nucleus_windows: CellWindows) -> xr.Dataset:
    """Twice as bright at the nucleus as at the membrane, dark in the nucleus; and a flat channel."""
    signal = profile_signal(cell.mask, cell.nucleus, lambda place: 100 + 100 * place, in_nucleus=20.0)
    images = xr.DataArray(
        np.stack([signal, np.full(signal.shape, 7.0)]),
        dims=("channel", "y", "x"),
        coords={"channel": ["GFP", "flat"]},
    )
    return sample(nucleus_windows, images)
