"""
From files to a study, and back to Python
=========================================

You have masks and signals in files. One command follows the cell and writes a folder of
tables, maps and pictures. This example first writes the files of a simulated cell.
"""

import subprocess
import sys
from pathlib import Path
from tempfile import mkdtemp

import matplotlib.pyplot as plt
import numpy as np
import tifffile

import cytodisk as cd

truth = cd.simulate.movie("fluctuating", seed=1, frames=16)
folder = Path(mkdtemp())
tifffile.imwrite(folder / "masks.tif", truth.masks.astype(np.uint8) * 255)
tifffile.imwrite(
    folder / "signal.tif",
    truth.signal.to_numpy(),
    imagej=True,
    metadata={"axes": "TCYX"},
)


# %%
# The command, as you type it in a terminal.
def cytodisk(command: str) -> None:
    """Run a command of cytodisk and print its output."""
    done = subprocess.run(
        [sys.executable, "-m", "cytodisk", *command.split()],
        cwd=folder,
        capture_output=True,
        text=True,
    )
    print(done.stdout + done.stderr)


cytodisk(
    "movie masks.tif --signal signal.tif -o out --channels matter,edge "
    "--pixel-size 0.16 --frame-interval 5 --sectors 40 --figures 0 --workers 1"
)
print(*sorted(file.name for file in (folder / "out").iterdir()), sep="\n")

# %%
# Read the results. Tables are pandas DataFrames, with their units in ``attrs``.
study = cd.open_study(folder / "out")
print(
    "cells:", study.cells["cell"].nunique(), "frames:", study.cells["frame"].nunique()
)
shown = ["frame", "area", "area_distortion", "certificate_valid", "status"]
print(study.cells[shown].head())
print(study.edge.attrs["units"]["velocity"], "and", study.cells.attrs["units"]["area"])

# %%
# The velocity of one sector, with its error bars.
one = study.edge.query("cell == 0 and sector == 10")
figure, ax = plt.subplots(figsize=(5, 2.4), layout="constrained")
ax.errorbar(
    one["time_s"],
    one["velocity"],
    one["velocity_error"],
    fmt="o-",
    markersize=2,
    linewidth=0.7,
)
ax.set(
    xlabel="time (s)",
    ylabel=f"velocity ({study.edge.attrs['units']['velocity']})",
    title="sector 10",
)
plt.show()

# %%
# The same numbers as arrays, and the map of any frame.
activity = study.activity(0)
print(activity["mean"].sizes)
disk = study.movie(0)[12]
figure, ax = plt.subplots(figsize=(4, 3), layout="constrained")
cd.plot.draw_window_means(
    ax,
    cd.polar_windows(layers=10, sectors=40).on(disk),
    activity["mean"].sel(channel="edge").isel(time=12),
)
plt.show()

# %%
# Next, type ``cytodisk correlate out --signal edge --with velocity`` and ``cytodisk
# report out``, or call :func:`cytodisk.run_correlate` and
# :func:`cytodisk.write_report`.
