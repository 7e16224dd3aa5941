"""What the plugin of napari adds to a change of frame, and to memory: `python benchmarks/napari_frames.py`.

A movie of 200 frames with 1 000 windows is simulated, mapped, and opened in a viewer over its signal. Each
change of the slider is timed until all that follows from it in this process is done, but for drawing: layers
are sliced and hand their pixels over, features, lines and colours are set. What a viewer with the signal
alone needs for the same is taken off. A screen is needed, or `xvfb-run -a`.
"""

from __future__ import annotations

import argparse
import gc
import tempfile
import time
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
import psutil
import tifffile

import cytodisk as cd
from cytodisk.store.study import Study

LIMIT_MS = 50.0
PLAYED_PER_S = 10


def main() -> None:
    """Print the times and the memory."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--frames", type=int, default=200)
    parser.add_argument("--study", type=Path, help="an own study of a movie, with --signal")
    parser.add_argument("--signal", type=Path, help="the image behind it, TCYX")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        study, signal = (
            simulated(Path(folder), given.frames)
            if given.study is None
            else (cd.open_study(given.study), tifffile.imread(given.signal))
        )
        measure(study, signal)


def simulated(folder: Path, frames: int) -> tuple[Study, Any]:
    """A movie with 10 × 100 windows, mapped, and its signal."""
    truth = cd.simulate.movie("fluctuating", frames=frames, radius_px=90.0, speed_px=0.5)
    signal = truth.signal.to_numpy().astype(np.float32)
    tifffile.imwrite(folder / "masks.tif", truth.masks.astype(np.uint8), metadata={"axes": "TYX"})
    tifffile.imwrite(folder / "signal.tif", signal, metadata={"axes": "TCYX"})
    study = cd.run_movie(
        folder / "masks.tif",
        folder / "study",
        signal=folder / "signal.tif",
        layers=10,
        sectors=100,
        pixel_size_um=0.16,
        frame_interval_s=5.0,
    )
    return study, signal


def measure(study: Study, signal: Any) -> None:
    """Print what a study's layers cost in a viewer."""
    from napari import Viewer

    from cytodisk.napari.study_layers.shown_study import show_study

    frames = len(signal)
    viewer = Viewer(show=False)
    viewer.add_image(signal, channel_axis=1)
    onward, back = range(frames), range(frames - 1, -1, -1)
    show_study(viewer, study)  # what is imported and compiled at first is no part of what frames take
    del viewer.layers[2:]
    plain = np.median(times(viewer, onward), axis=0)
    gc.collect()
    before = memory_mb()
    start = time.perf_counter()
    shown = show_study(viewer, study)
    opened = 1e3 * (time.perf_counter() - start)
    jumps = np.random.default_rng(0).permutation(frames)
    print(f"{frames} frames, {shown.painted.n_windows} windows, image {shown.painted.shape}")
    print(f"a viewer with the signal alone: {plain[0]:.1f} ms a frame")
    print(f"opening the study: {opened:.0f} ms")
    tell("first visit, jumping (nothing is read ahead)", times(viewer, jumps), plain)
    tell("revisit, back to back", times(viewer, back), plain)
    gc.collect()
    print(f"memory: {memory_mb() - before:.0f} MB more after all frames were seen twice")
    del viewer.layers[2:], shown
    show_study(viewer, study)
    played = times(viewer, onward, 1 / PLAYED_PER_S)
    tell(f"first visit, played at {PLAYED_PER_S} frames a second", played, plain)
    tell("revisit, jumping", times(viewer, jumps), plain)
    viewer.close()


def times(viewer: Any, frames: Iterable[int], rest_s: float = 0.0) -> Any:
    """Time that each change of the slider takes, in ms: by the clock, and of the processor in this thread."""
    found = []
    for frame in frames:
        start, work = time.perf_counter(), time.thread_time()
        viewer.dims.set_current_step(0, int(frame))
        found.append((1e3 * (time.perf_counter() - start), 1e3 * (time.thread_time() - work)))
        time.sleep(max(0.0, rest_s - 1e-3 * found[-1][0]))
    return np.array(found)


def tell(what: str, taken_ms: Any, plain_ms: Any) -> None:
    """Print how long it took."""
    words = [
        f"{np.median(added):.1f} ms, 95 % below {np.percentile(added, 95):.1f}, at most {added.max():.0f}"
        for added in (taken_ms - plain_ms).T
    ]
    print(f"{what}: {words[0]} (of the processor {words[1]})")


def memory_mb() -> float:
    """Resident memory of this process."""
    return float(psutil.Process().memory_info().rss / 2**20)


if __name__ == "__main__":
    main()
