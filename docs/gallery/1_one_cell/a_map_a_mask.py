"""
Map one cell onto the disk
==========================

A mask goes in, a map comes out: one to one, with equal areas as nearly as the boundary
allows, and with a proof that it is one to one. Every point of the cell has one place on
the disk, and back.
"""

# %%
# A simulated cell with a broad front and a thin tail. A mask of your own comes from
# :func:`cytodisk.read_image`, or from any array.
import matplotlib.pyplot as plt
import numpy as np

import cytodisk as cd

cell = cd.simulate.cell_with_signal(seed=0)
disk = cd.map_to_disk(cell.mask)
print(disk)

# %%
# The mesh in the cell and on the disk: the same triangles, none turned over. Angle 0
# points along +x of the image and angles grow towards +y, so the disk looks like the
# cell.
figure, axes = plt.subplots(
    1, 2, figsize=(6.2, 2.6), width_ratios=(1.5, 1), layout="constrained"
)
cd.plot.draw_mesh(axes[0], disk.vertices_yx, disk.triangles)
cd.plot.frame_cell(axes[0], disk, pixel_size_um=0.16)
cd.plot.draw_disk_mesh(axes[1], disk)
axes[0].set_title("the cell")
axes[1].set_title("its disk")
plt.show()

# %%
# The proof
# ---------
# The certificate is computed from the arrays alone: all triangles positive in the
# cell and in the disk, the boundary once around the circle, the mesh a topological
# disk. Signs that rounding leaves in doubt are decided with exact arithmetic. See
# :doc:`/algorithms/certificate`.
certificate = disk.certificate
print("valid:", certificate.valid)
print(
    "triangles:",
    certificate.n_triangles,
    "of which turned over:",
    len(certificate.flipped_in_disk),
)

# %%
# How far it keeps areas
# ----------------------
# λ is a triangle's share of the disk over its share of the cell. The area distortion
# is the mean magnitude of its logarithm.
figure, ax = plt.subplots(figsize=(6.2, 3.2), layout="constrained")
filled = cd.plot.draw_area_distortion(ax, disk, pixel_size_um=0.16)
figure.colorbar(filled, ax=ax, label="log₂ λ", shrink=0.7)
print(f"area distortion: {disk.distortion.area:.3f}")
print(f"angle distortion: {disk.distortion.angle:.2f}")
plt.show()

# %%
# There and back
# --------------
# Both directions are exact, also for points between pixels. Points outside the cell
# are NaN.
points_yx = np.array([[70.0, 120.0], [80.5, 60.25], [0.0, 0.0]])
points_uv = disk.to_disk(points_yx)
print(points_uv.round(3))
print(
    "farthest from where it began:",
    np.nanmax(np.abs(disk.to_cell(points_uv) - points_yx)),
    "px",
)
