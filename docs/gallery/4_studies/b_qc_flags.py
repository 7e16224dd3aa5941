"""
QC flags: look at them first
============================

A mask that is wrong in one frame can outweigh all other frames. QC flags name such
frames. The report shows them first.
"""

import subprocess
import sys
import textwrap
from pathlib import Path
from tempfile import mkdtemp

import matplotlib.pyplot as plt
import numpy as np
import tifffile

import cytodisk as cd

# %%
# A movie in which the mask of frame 8 lost a piece of the cell, as happens when a
# bright neighbour changes the threshold.
truth = cd.simulate.movie("migrating", seed=1, frames=18)
masks = truth.masks.copy()
columns = np.flatnonzero(masks[8].any(axis=0))
masks[8, :, columns[-18] :] = False

folder = Path(mkdtemp())
tifffile.imwrite(folder / "masks.tif", masks.astype(np.uint8) * 255)
command = (
    "movie masks.tif -o out --pixel-size 0.16 --frame-interval 5 "
    "--sectors 40 --figures 0 --quiet"
)
done = subprocess.run(
    [sys.executable, "-m", "cytodisk", *command.split()], cwd=folder, check=True
)

# %%
# The most serious flag comes first. Each has its meaning, a remedy and its frames.
study = cd.open_study(folder / "out")
for flag in cd.qc_flags(study):
    print(flag.what.upper())
    print(*textwrap.wrap(f"{flag.meaning} {flag.advice}", 88), sep="\n")
    for place in flag.places:
        print("   frame", place.frame, place.note)

# %%
# The same in a picture: the velocity jumps before and after that frame.
velocity = study.activity(0)["velocity"]
figure, ax = plt.subplots(figsize=(5.6, 2.8), layout="constrained")
cd.plot.draw_velocity_map(ax, velocity)
plt.show()

# %%
# Correct the mask, or leave the frames out of a correlation: ``cytodisk correlate out
# --without-frames 7,8``.
