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
# Each window is a polygon with a name and measurements: its area, and the numbers that
# you passed. The cell comes first if you give it a name. In QuPath the cell is an
# annotation and the windows are detections in it.
collection = windows.geojson({"mean edge a.u.": means.to_numpy()}, cell="cell 0")
cell_outline, first, *_ = collection["features"]
print(cell_outline["properties"])
print(first["properties"], "and", len(first["geometry"]["coordinates"][0]), "points")

# %%
# Write the file, and read it as another program would.
with TemporaryDirectory() as folder:
    file = Path(folder) / "windows.geojson"
    file.write_text(json.dumps(collection))
    features = json.loads(file.read_text())["features"][1:]

figure, ax = plt.subplots(figsize=(5, 3), layout="constrained")
polygons = PolyCollection(
    [feature["geometry"]["coordinates"][0] for feature in features],
    array=[
        feature["properties"]["measurements"]["mean edge a.u."] for feature in features
    ],
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
# Coordinates count from the corner of the image, as in QuPath and Fiji: the first pixel
# covers 0 to 1. In cytodisk's own arrays the middle of the first pixel is (0, 0).
