"""From a microscope's file to results, as a user types it."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import zarr
from command_line import Run, assert_refused, write

import cytodisk as cd


def _save(path: Path, stack: np.ndarray, axes: str) -> Path:
    units = {"t": "second", "z": "micrometer", "y": "micrometer", "x": "micrometer"}
    steps = {"t": 5.0, "y": 0.16, "x": 0.16}
    described = [{"name": axis} | ({"unit": units[axis]} if axis in units else {}) for axis in axes]
    scale = [{"type": "scale", "scale": [steps.get(axis, 1.0) for axis in axes]}]
    ome: dict[str, Any] = {
        "multiscales": [{"axes": described, "datasets": [{"path": "0", "coordinateTransformations": scale}]}],
        "omero": {"channels": [{"label": "GFP"}, {"label": "RFP"}]},
    }
    group = zarr.create_group(path, attributes={"ome": ome})
    group.create_array("0", shape=stack.shape, dtype=stack.dtype)[...] = stack
    return path


@pytest.fixture
def masks(tmp_path: Path) -> Path:
    truth = cd.simulate.movie("still", frames=2, radius_px=14.0)
    return _save(tmp_path / "masks.ome.zarr", truth.masks.astype(np.uint8), "tyx")


@pytest.fixture
def signal(tmp_path: Path, masks: Path) -> Path:
    """Two channels, three slices in z."""
    height, width = zarr.open_array(masks / "0").shape[1:]
    values = np.random.default_rng(1).integers(0, 4000, (2, 2, 3, height, width), np.uint16)
    return _save(tmp_path / "signal.zarr", values, "tczyx")


def test_a_movie_of_ome_zarr(run: Run, tmp_path: Path, masks: Path, signal: Path) -> None:
    out, grid = tmp_path / "out", ("--layers", 2, "--sectors", 6)
    assert_refused(run("movie", masks, "--signal", signal, "-o", out, *grid), "3 slices", "--z 1", "--z max")
    code, said, error = run(
        "movie", masks, "--signal", signal, "--z", "max", "--signal-channels", "RFP", "-o", out, *grid
    )
    assert (code, error) == (0, "")
    assert "pixel size: 0.16 µm" in said
    assert "frame interval: 5 s" in said
    study = cd.open_study(out)
    assert set(study.windows["channel"]) == {"RFP"}
    mean = study.windows.query("frame == 1")
    highest = zarr.open_array(signal / "0")[1, 1].max(axis=0)[cd.read_image(masks).values[1] > 0].mean()
    assert np.average(mean["mean"], weights=mean["area"]) == pytest.approx(highest)


def test_a_changed_folder_is_another_input(run: Run, tmp_path: Path, masks: Path, signal: Path) -> None:
    arguments = (
        "map",
        masks,
        "--signal",
        signal,
        "--z",
        1,
        "-o",
        tmp_path / "out",
        "--layers",
        2,
        "--sectors",
        6,
    )
    assert run(*arguments, "--figures", 0)[0] == 0
    before = json.loads((tmp_path / "out" / "provenance.json").read_text())["inputs"]["signal"]["sha256"]
    zarr.open_array(signal / "0")[0, 0, 0, 0, 0] += 1
    assert_refused(run(*arguments, "--figures", 0, "--resume"), "signal")
    assert run(*arguments, "--figures", 0, "--overwrite")[0] == 0
    after = json.loads((tmp_path / "out" / "provenance.json").read_text())["inputs"]["signal"]["sha256"]
    assert after != before


def test_check_lists_what_there_is_to_choose(run: Run, tmp_path: Path, masks: Path, signal: Path) -> None:
    result = run("check", masks, "--signal", signal)
    assert_refused(result, "3 slices", "--z max")
    assert "signal.zarr: 2 frames, 3 slices in z, 2 channels (GFP, RFP)" in result[1]
    assert "masks.ome.zarr: 2 frames" in result[1]
    code, said, _ = run("check", masks, "--signal", signal, "--z", "mean")
    assert code == 0
    assert "mean of 3 slices in z" in said
    plain = write(tmp_path / "plain.tif", cd.read_image(masks).values, metadata={"axes": "TYX"})
    assert_refused(run("check", plain, "--scene", 1), "--scene 1 chooses nothing", "leave out --scene")
