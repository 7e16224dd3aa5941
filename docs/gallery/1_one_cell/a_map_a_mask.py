"""
Map one cell onto the disk
==========================

You pass a mask and get a map. The map is one to one, comes with a proof of that, and
keeps areas as nearly as the boundary allows. Every point of the cell has one position
on the disk, and every point of the disk one in the cell.
"""

# %%
# A simulated cell with a broad front and a thin tail. Read your own mask with
# :func:`cytodisk.read_image`, or pass any array.
import matplotlib.pyplot as plt
import numpy as np

import cytodisk as cd

cell = cd.simulate.cell_with_signal(seed=0)
disk = cd.map_to_disk(cell.mask)
print(disk)

# %%
# The mesh in the cell and on the disk has the same triangles, and none is turned over.
# Angle 0 points along +x of the image. Angles grow towards +y, so the disk looks like
# the cell.
figure, axes = plt.subplots(
    1, 2, figsize=(6.2, 2.6), width_ratios=(1.5, 1), layout="constrained"
)
cd.plot.draw_mesh(axes[0], disk.vertices_yx, disk.triangles)
cd.plot.frame_cell(axes[0], disk, scale=cd.Scale(0.16))
cd.plot.draw_disk_mesh(axes[1], disk)
axes[0].set_title("the cell")
axes[1].set_title("its disk")
plt.show()

# %%
# The proof
# ---------
# The certificate is computed from the arrays alone. All triangles are positive in the
# cell and in the disk, the boundary goes around the circle once, and the mesh is a
# topological disk. Where rounding could change a sign, exact arithmetic decides. See
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
# Distortion
# ----------
# λ is a triangle's share of the disk over its share of the cell. The area distortion
# is the mean of \|ln λ\|: 0.03 is about 3 % off.
figure, ax = plt.subplots(figsize=(6.2, 3.2), layout="constrained")
filled = cd.plot.draw_area_distortion(ax, disk, scale=cd.Scale(0.16))
figure.colorbar(filled, ax=ax, label="log₂ λ", shrink=0.7)
print(f"area distortion: {disk.distortion.area:.3f}")
print(f"angle distortion: {disk.distortion.angle:.2f}")
plt.show()

# %%
# From cell to disk and back
# --------------------------
# Both directions are exact, for points between pixels, too. Points outside the cell
# give NaN.
points_yx = np.array([[70.0, 120.0], [80.5, 60.25], [0.0, 0.0]])
points_uv = disk.to_disk(points_yx)
print(points_uv.round(3))
print(
    "farthest from where it began:",
    np.nanmax(np.abs(disk.to_cell(points_uv) - points_yx)),
    "px",
)
