"""
Red flags: what to look at before anything else
===============================================

A mask that is wrong in one frame can outweigh all others. Red flags find such frames in
the tables of a study; the report shows them first.
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
# A movie in which frame 8 lost a part of the cell, as happens when a bright
# neighbour moves the threshold.
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
# The gravest first, each with what it means and the frames it is about.
study = cd.open_study(folder / "out")
for flag in cd.red_flags(study):
    print(flag.what.upper())
    print(*textwrap.wrap(f"{flag.meaning} {flag.advice}", 88), sep="\n")
    for place in flag.places:
        print("   frame", place.time, place.note)

# %%
# The same in a picture: a leap of the velocity in and out of that frame.
velocity = study.edge.pivot(index="time", columns="sector", values="velocity")
figure, ax = plt.subplots(figsize=(5.6, 2.8), layout="constrained")
cd.plot.draw_velocity_map(ax, velocity.to_numpy(), frame_interval_s=5)
plt.show()

# %%
# Leave such frames out of a correlation with ``cytodisk correlate out
# --without-frames 7,8``, or mend the mask.
