"""
A cell with its nucleus
=======================

Layers tell how deep a place is below the membrane. With a mask of the nucleus they
also tell how near it is to the nucleus: the nucleus gets a circle of its own in the
disk, and layers run from the membrane to the nuclear outline.
"""

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr

import cytodisk as cd

cell = cd.simulate.cell_with_nucleus(
    "off centre", seed=5, shape="spread", radius_px=60.0
)

# %%
# Two simulated signals: an organelle that gathers at the nucleus, and a cortex at the
# membrane. ``profile_signal`` knows their true course.


def organelle(place):
    return 40 + 160 * place**3


def cortex(depth_px):
    return 60 + 120 * np.exp(-depth_px / 4)


signal = xr.DataArray(
    np.stack(
        [
            cd.simulate.profile_signal(
                cell.mask, cell.nucleus, organelle, in_nucleus=30, noise_seed=0
            ),
            cd.simulate.profile_signal(
                cell.mask,
                cell.nucleus,
                cortex,
                along="depth",
                in_nucleus=60,
                noise_seed=1,
            ),
        ]
    ),
    dims=("channel", "y", "x"),
    coords={"channel": ["organelle", "cortex"]},
)

# %%
# Pass the nucleus beside the mask of the whole cell. The certificate proves the map
# compartment by compartment.
disk = cd.map_to_disk(cell.mask, nucleus=cell.nucleus, pixel_size_um=0.16)
print("valid:", disk.certificate.valid, "; radius of the nucleus:", disk.nucleus_radius)

# %%
# ``nucleus_layers`` layers of the nucleus follow those of the cytoplasm. No window lies
# on both sides of the nuclear outline.
windows = cd.polar_windows(layers=8, sectors=24, nucleus_layers=3).on(disk)
print(windows.grid.compartments)
print("empty windows:", windows.n_empty)

figure, axes = plt.subplots(2, 3, figsize=(6.6, 4.6), layout="constrained")
cd.plot.draw_cell(axes[0, 0], signal[0], disk)
cd.plot.draw_windows(axes[0, 0], windows)
cd.plot.draw_disk_image(axes[1, 0], disk, signal[0])
cd.plot.draw_windows(axes[0, 1], windows, by_layer=True)
cd.plot.draw_outline(axes[0, 1], disk)
cd.plot.frame_cell(axes[0, 1], disk)
cd.plot.draw_disk_windows(axes[1, 1], windows.grid, by_layer=True, color="white")
data = cd.sample(windows, signal)
cd.plot.draw_window_means(axes[0, 2], windows, data["mean"][0])
cd.plot.draw_disk_means(axes[1, 2], windows.grid, data["mean"][0])
for ax, title in zip(
    axes[0],
    ("organelle and windows", "layers, nucleus blue", "mean of each window"),
    strict=True,
):
    ax.set_title(title)
plt.show()

# %%
# From the nucleus to the membrane
# --------------------------------
# The line is the mean of a layer, its band the quartiles of the sectors. Both borders
# are marked. Below each layer stands its depth.
figure, axes = plt.subplots(1, 2, figsize=(6.6, 2.6), layout="constrained")
cd.plot.draw_nucleus_profile(axes[0], data)
cd.plot.draw_nucleus_profile(axes[1], data, along="distance")
axes[0].legend(frameon=False)
plt.show()

# %%
# In numbers
# ----------
# ``nucleus_to_cytoplasm`` is the mean in the nucleus over that in the cytoplasm.
# ``perinuclear_share`` is the share of the cytoplasm's signal in the innermost third of
# its area. A signal that is the same everywhere has 0.33.
summary = cd.nucleus_summary(disk, data)
names = ("nucleus_to_cytoplasm", "perinuclear_share", "peripheral_share")
print(summary[list(names)].to_dataframe().round(2))
print("offset of the nucleus:", round(float(summary["nucleus_offset"]), 2), "µm")

# %%
# Where "perinuclear" is
# ----------------------
# Windows of the cytoplasm have equal areas. Where the nucleus is close to the membrane,
# all layers lie in the narrow gap; on the far side the innermost layer reaches further
# from the nucleus. ``nucleus_distance`` tells how far each window is.
distance = data["nucleus_distance"].sel(layer=7)
print(
    "innermost layer: median", round(float(distance.median()), 2), "µm from the nucleus"
)
print(
    "its sectors:",
    round(float(distance.min()), 2),
    "to",
    round(float(distance.max()), 2),
)

# %%
# Turned by the nucleus
# ---------------------
# ``align="nucleus"`` puts the direction from the nucleus' centroid to the cell's at
# angle 0, so that sectors compare between cells. The ring marks sector 0: it now lies
# where the cell reaches furthest from its nucleus.
turned = cd.map_to_disk(
    cell.mask, nucleus=cell.nucleus, align="nucleus", pixel_size_um=0.16
)
grid = cd.polar_windows(layers=8, sectors=24, nucleus_layers=3)
figure, axes = plt.subplots(1, 2, figsize=(5.0, 2.4), layout="constrained")
for ax, one, title in zip(axes, (disk, turned), ("upright", "nucleus"), strict=True):
    laid = grid.on(one)
    cd.plot.draw_sectors(ax, laid)
    cd.plot.frame_cell(ax, one)
    ax.set_title(f'align="{title}"')
plt.show()
