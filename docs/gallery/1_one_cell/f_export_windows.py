"""
Take windows to QuPath, Fiji or napari
======================================

You can write the outlines of all windows as GeoJSON, with your numbers beside them. The
command ``cytodisk map masks.tif -o out/ --geojson`` does it for every cell.
"""

import json
from pathlib import Path
from tempfile import TemporaryDirectory

import matplotlib.pyplot as plt
from matplotlib.collections import PolyCollection

import cytodisk as cd

cell = cd.simulate.cell_with_signal(seed=1)
windows = cd.polar_windows(layers=6, sectors=36).on(cd.map_to_disk(cell.mask))
means = cd.sample(windows, cell.signal)["mean"].sel(channel="edge")

# %%
# Each window is a polygon with its layer, sector, area, and the numbers that you
# passed.
collection = windows.geojson({"edge": means.to_numpy()})
first = collection["features"][0]
print(first["properties"], "and", len(first["geometry"]["coordinates"][0]), "points")

# %%
# Write the file, and read it as another program would.
with TemporaryDirectory() as folder:
    file = Path(folder) / "windows.geojson"
    file.write_text(json.dumps(collection))
    features = json.loads(file.read_text())["features"]

figure, ax = plt.subplots(figsize=(5, 3), layout="constrained")
polygons = PolyCollection(
    [feature["geometry"]["coordinates"][0] for feature in features],
    array=[feature["properties"]["edge"] for feature in features],
    edgecolor="white",
    linewidth=0.3,
)
ax.add_collection(polygons)
ax.autoscale_view()
ax.set_aspect("equal")
ax.invert_yaxis()
ax.set(xlabel="x (px)", ylabel="y (px)")
figure.colorbar(polygons, label="mean signal (a.u.)", shrink=0.8)
plt.show()

# %%
# Coordinates count from the middle of a pixel. Programs that count from its corner,
# such as QuPath, need 0.5 added to both.
