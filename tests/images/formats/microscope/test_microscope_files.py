import logging
import sys
import warnings
from pathlib import Path

import numpy as np
import pytest
import tifffile
import zarr

from cytodisk.errors import MissingPartError, ReadError
from cytodisk.images.contents import contents, holds_scenes
from cytodisk.images.formats.microscope.quiet import quiet
from cytodisk.images.frame_file import FileChoice
from cytodisk.images.frames import open_frames


@pytest.mark.parametrize(("ending", "package"), [("nd2", "nd2"), ("czi", "czifile"), ("lif", "liffile")])
def test_a_missing_reader_is_named_with_what_to_type(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, ending: str, package: str
) -> None:
    monkeypatch.setitem(sys.modules, package, None)
    path = tmp_path / f"a.{ending}"
    path.write_bytes(b"no matter what")
    for look in (open_frames, contents):
        with pytest.raises(MissingPartError, match=rf"needs {package}, .*pip install 'cytodisk\[{ending}\]'"):
            look(path)


def test_what_a_plain_file_holds(tmp_path: Path) -> None:
    path = tmp_path / "a.ome.tif"
    stack = np.zeros((3, 2, 20, 30), np.uint16)
    metadata = {"axes": "TCYX", "PhysicalSizeX": 0.16, "PhysicalSizeY": 0.16, "Channel": {"Name": ["a", "b"]}}
    tifffile.imwrite(path, stack, metadata=metadata)
    (line,) = contents(path).lines
    assert line == "a.ome.tif: 3 frames, 2 channels (a, b), 20 × 30 px of uint16, 0.16 µm a pixel"
    assert not holds_scenes(path)


def test_a_choice_for_another_file_is_ignored_where_there_is_one_scene_and_slice(tmp_path: Path) -> None:
    axes = [{"name": axis} for axis in "yx"]
    ome = {"multiscales": [{"axes": axes, "datasets": [{"path": "0"}]}]}
    zarr.create_group(tmp_path / "a.zarr", attributes={"ome": ome})
    array = zarr.create_array(tmp_path / "a.zarr" / "0", shape=(20, 30), dtype="u1")
    array[...] = 7
    file = open_frames(tmp_path / "a.zarr", choice=FileChoice(scene="5", z="max"))
    assert (file.frame(0) == 7).all()
    with pytest.raises(ReadError, match="leave out --signal-axes"):
        open_frames(tmp_path / "a.zarr", choice=FileChoice(axes="YX"))


def test_a_library_is_quiet_only_while_it_reads(capfd: pytest.CaptureFixture[str]) -> None:
    log = logging.getLogger("czifile")
    with quiet("czifile"):
        log.error("not printed")
        warnings.warn("not raised", stacklevel=1)
    assert not log.disabled
    assert capfd.readouterr() == ("", "")
