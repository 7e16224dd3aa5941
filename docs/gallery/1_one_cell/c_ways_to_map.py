"""
Harmonic map, equal areas, and between
======================================

The harmonic map keeps angles where it can, and so makes thin parts of a cell tiny on
the disk. The relaxation that follows gives every part its share of area. You can also
compare with the paper's own relaxation, "advection".
"""

import matplotlib.pyplot as plt

import cytodisk as cd

mask = cd.simulate.star(arms=5, body_radius=14, arm_length=24, arm_width=6)
methods = ("harmonic", "advection", "newton")
disks = {method: cd.map_to_disk(mask, method=method) for method in methods}

# %%
# Top: where a map makes parts of the cell too large (red) or too small (blue) on the
# disk. Bottom: windows of equal area on the disk, carried into the cell. With the
# harmonic map the arms lie in the outermost windows; the other maps divide them evenly.
grid = cd.polar_windows(layers=6, sectors=30)
figure, axes = plt.subplots(2, 3, figsize=(6.2, 4.2), layout="constrained")
for column, (method, disk) in enumerate(disks.items()):
    cd.plot.draw_area_distortion(axes[0, column], disk, limit=4)
    axes[0, column].set_title(method)
    cd.plot.draw_windows(axes[1, column], grid.on(disk), by_layer=True)
    cd.plot.frame_cell(axes[1, column], disk)
plt.show()

# %%
# The area distortion (0 is perfect), and whether the map is one to one. Advection can
# turn triangles over. Its certificate is then not valid, and says which triangles.
for method, disk in disks.items():
    flipped = len(disk.certificate.flipped_in_disk)
    print(
        f"{method:9s}: area distortion {disk.distortion.area:.3f}, "
        f"valid {disk.certificate.valid}, turned over {flipped}"
    )

# %%
# A dial between angles and areas
# -------------------------------
# ``shape_weight`` sets how much shape counts against area. A small value keeps areas, a
# large value keeps angles. An area distortion of 0 and an angle distortion of 1 are
# perfect.
for weight in (0.0005, 0.005, 0.05, 0.5):
    found = cd.map_to_disk(mask, shape_weight=weight).distortion
    print(f"shape_weight {weight:<6}: area {found.area:.3f}, angle {found.angle:.2f}")
found = disks["harmonic"].distortion
print(f"harmonic            : area {found.area:.3f}, angle {found.angle:.2f}")
