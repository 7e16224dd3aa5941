"""
Kymographs along a line and along the edge
==========================================

A line kymograph shows intensity along a fixed line over time. An edge kymograph follows
the cell: it shows intensity along the tracked edge, at a depth below it.
"""

import matplotlib.pyplot as plt

import cytodisk as cd

truth = cd.simulate.movie("bulging", seed=0, frames=30)
movie = cd.map_movie(
    truth.masks,
    pixel_size_um=truth.pixel_size_um,
    frame_interval_s=truth.frame_interval_s,
)
signal = truth.signal.sel(channel="edge")

# %%
# A line, three pixels wide, from the middle of the image to its right side.
middle = signal.sizes["y"] // 2, signal.sizes["x"] // 2
end = (middle[0], signal.sizes["x"] - 2)
line = cd.line_kymograph([middle, end], signal, width_px=3)

figure, axes = plt.subplots(
    1, 2, figsize=(6.2, 2.4), width_ratios=(1, 1.6), layout="constrained"
)
axes[0].imshow(signal.isel(time=0), cmap="gray")
axes[0].plot(*zip(middle[::-1], end[::-1], strict=True), color="#009E73")
axes[0].axis("off")
cd.plot.draw_line_kymograph(axes[1], line)
plt.show()

# %%
# Along the tracked edge, half a micrometre deep. Protrusions come and go, and each
# stays at its height in the picture.
rim = cd.boundary_kymograph(movie, 0.5, signal)
figure, ax = plt.subplots(figsize=(5.6, 2.8), layout="constrained")
cd.plot.draw_boundary_kymograph(ax, rim)
plt.show()
