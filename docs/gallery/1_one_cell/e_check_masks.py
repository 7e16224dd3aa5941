"""
What is wrong with a mask
=========================

A map needs one piece without holes. Cleaning makes such a mask and reports each change.
On the command line, ``cytodisk check masks.tif`` prints the same for all masks of a
file, a line for each kind of fault.
"""

import matplotlib.pyplot as plt
import numpy as np

import cytodisk as cd

# %%
# A badly segmented cell: the mask has a piece of a neighbour, and a hole where the
# nucleus is dim.
mask = cd.simulate.migrating(seed=3)
mask[5:30, 20:50] = True
row, column = np.argwhere(mask).mean(axis=0).astype(int)
mask[row - 8 : row + 8, column : column + 20] = False

cleaned, report = cd.clean_mask(mask)
print("notes: ", *report.notes, sep="\n  ")
print("QC flags:", *report.qc_flags, sep="\n  ")

# %%
# What cleaning changed.
change = cleaned.astype(int) - mask
figure, ax = plt.subplots(figsize=(5, 2.8), layout="constrained")
ax.imshow(mask, cmap="gray", alpha=0.4)
ax.contour(cleaned, [0.5], colors="k", linewidths=1)
ax.contourf(change, [-1.5, -0.5], colors=["#D55E00"])
ax.contourf(change, [0.5, 1.5], colors=["#0072B2"])
ax.set_title("mapped (black), dropped (orange), filled (blue)")
ax.axis("off")
plt.show()

# %%
# If cleaning must not change a mask, say so. Such a mask then ends in an error that
# says what came and what to do.
try:
    cd.clean_mask(mask, fragments="error")
except cd.errors.MaskError as error:
    print(error)
