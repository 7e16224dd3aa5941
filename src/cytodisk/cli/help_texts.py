"""What `cytodisk --help` and `cytodisk COMMAND --help` say of each command."""

HELP = {
    "map": """Map masks onto the disk and sample a signal in windows, into a study folder.

MASKS is one mask, a stack of masks, or a label image (each label a cell), as TIFF or PNG; or outlines of
cells (ImageJ's .roi and .zip, QuPath's .geojson); or a folder of mask files, as Cellpose writes them
(_masks.tif, _cp_masks.png, _seg.npy). Cells are counted through all files.

Examples:

  cytodisk map mask.tif -o out/

  cytodisk map masks.tif --signal image.ome.tif -o out/ --layers 10 --sectors 60 --workers 2

  cytodisk map cellpose_folder/ --signal _img -o out/ --workers 4 --no-maps

  cytodisk map cellpose_folder/ --signal _img -o out/ --groups groups.csv

  cytodisk map labels.tif -o out/ --parameters other_study/parameters.toml --resume

Exit code: 0 when done (refused cells have a row with the reason), 2 if nothing could be mapped or an input is
damaged (the rest is done all the same).
""",
    "movie": """Follow cells through a movie: maps, activity of a signal, edge velocity, into a study folder.

MASKS is a stack of masks of one cell, or label images in which a label is a cell in all frames: one file, or
a folder or a pattern in quotes of one file a frame, in the order of the numbers in their names. So is
--signal.

Examples:

  cytodisk movie masks.tif --signal movie.ome.tif -o out/ --layers 10 --sectors 60 --workers 2

  cytodisk movie masks.tif --signal movie.tif -o out/ --pixel-size 0.16 --frame-interval 5 --depth-um 0.5,1,2

  cytodisk movie cellpose_folder/ --signal cellpose_folder/ -o out/ --link

  cytodisk movie labels.tif --tracks trackmate.xml --signal movie.tif -o out/

  cytodisk movie 'masks/t*.tif' --signal 'images/t*.tif' -o out/ --resume

Exit code: 0 when done (frames without a map have a row with the reason), 2 if nothing could be mapped.
""",
    "batch": """Run many movies and images in one go, and merge their tables.

STUDY is a TOML file that names the inputs, by patterns or in a table, with their condition, experiment and
scale. Cells of one input that differ go into a table of groups (--groups). Each input runs in a process of
its own: a crash, a time-out or a lack of memory costs a row, not the run.
No figures are drawn but those of report.html: cytodisk correlate and cytodisk population draw what the folder
holds, with --format, and cytodisk map and movie the cells of one input.

Examples:

  cytodisk batch study.toml -o out/ --dry-run

  cytodisk batch study.toml -o out/ --workers 4 --time-limit 3600

  cytodisk batch study.toml -o out/ --workers 4 --resume

  cytodisk batch study.toml -o /shared/out --scheduler tcp://10.0.0.1:8786

Exit code: 0 when done (an input that failed has a row with the reason), 2 if no input went well, or the
batch file or the folder cannot be used. With --dry-run 2 if files of an input cannot be used.
""",
    "correlate": """Correlate a signal with the motion of the edge, or with another signal, window by window.

STUDY is the folder that cytodisk movie wrote. Positive lag: the edge moves after the signal. Tables and
figures go to STUDY/correlation/SIGNAL~WITH.

Of a folder that cytodisk batch wrote, each movie is correlated, and the curves of all cells are pooled: mean
and interval over experiments, tested against 0 and between conditions. A figure and tables go to the same
place in the folder of the batch.

Examples:

  cytodisk correlate out/ --signal VASP --with velocity --max-lag 20

  cytodisk correlate out/ --signal Rac1 --with RhoA --pairs --format pdf,png

  cytodisk correlate out/ --signal Rac1 --with Rac1 --against edge --detrend linear

  cytodisk correlate all/ --signal Rac1 --compare control,drug --resume

Exit code: 0 when done (a cell that cannot be correlated has a row with the reason), 2 if none could be.
""",
    "predict": """Test whether one signal predicts another, in both directions, layer by layer.

STUDY is the folder that cytodisk movie wrote. The question: does the past of the source make the error of
predicting the target smaller than the target's own past, its neighbours' past, and the signals given do?
Source to target and back are both tested. Without --source and --target all channels and velocity are tested
against each other, each pair with all others given: a network. Tables and figures go to
STUDY/prediction/SOURCE~TARGET or STUDY/prediction/network.

Predicting is what a cause would do, but no proof of one: a common driver that is not given does it, too.

Of a folder that cytodisk batch wrote, each movie is tested, and the gains of all cells are pooled: mean and
interval over experiments, tested against 0 and between conditions. A figure and tables go to the same place
in the folder of the batch.

Examples:

  cytodisk predict out/ --source Rac1 --target velocity

  cytodisk predict out/ --source Rac1 --target velocity --given RhoA --name given_RhoA

  cytodisk predict out/

  cytodisk predict out/ --source Rac1 --target RhoA --max-order 12 --surrogates 1999 --format pdf,png

  cytodisk predict all/ --source Rac1 --target velocity --compare control,drug --resume

Exit code: 0 when done (a cell in which nothing can be tested has a row with the reason), 2 if none could be.
""",
    "waves": """Do waves run along the edge of cells, or through a signal, and which way?

STUDY is the folder that cytodisk movie wrote. Without --signal the velocity of the edge is looked at; with it
every layer of a channel. Speeds are positive towards higher sectors, which is clockwise as seen in the image.
Tables and figures go to STUDY/waves/SIGNAL.

Of a folder that cytodisk batch wrote, waves are looked for in each movie, and their numbers are pooled: mean
and interval over experiments; their order is tested against 0, and all between conditions. A figure and
tables go to the same place in the folder of the batch.

Examples:

  cytodisk waves out/

  cytodisk waves out/ --signal Rac1

  cytodisk waves out/ --signal Rac1 --layer 2 --format pdf,png

  cytodisk waves out/ --frames 0:200 --name early

  cytodisk waves all/ --compare control,drug --resume

Exit code: 0 when done (a cell in which waves cannot be looked for has a row with the reason), 2 if there is
none in which they can.
""",
    "shapes": """Measure the shape of cells in a hundred features, and order them from plain to complex ones.

MASKS is one mask, a stack of masks, or a label image (each label a cell), or a folder of such files.
The score of complexity (features, UMAP, principal axis) is relative to the cells of the run: at least ten.

Examples:

  cytodisk shapes labels.tif -o out/ --pixel-size 0.3

  cytodisk shapes cellpose_folder/ -o out/ --workers 4

Exit code: 0 when done (refused cells have a row with the reason), 2 if nothing could be measured.
""",
    "population": """Compare conditions: is the signal different, where, by how much, and how sure is that?

PATH is what cytodisk batch, map, movie or shapes wrote, or a folder of such studies. Each cell needs a
condition and an experiment, the independent repetition (day, dish, animal): from the batch file, or from
--groups table.csv with the columns file or cell, condition and experiment. Experiments are compared, not
cells: cells of one dish are not independent.

Examples:

  cytodisk population all/ --compare control,drug --channel Rac1 --align nucleus -o atlas/

  cytodisk population out/ --groups table.csv -o atlas/

  cytodisk population all/ --dose dose --normalise "cell mean" -o doses/

  cytodisk population --power

  cytodisk population all/ --power --effects 1,2 --experiments 4,6

With --power nothing is compared: a table says how often a difference of a size is found with so many
experiments, with the variances of your cells where you pass PATH.

Exit code: 0 when done, 2 if there is nothing to show, or the input or the folder cannot be used.
""",
    "report": """Write one HTML page that shows a study, a batch or a population, with what was found first.

A movie: QC flags, linked views of one cell. Single masks: QC flags, all cells to sort and to open. A batch:
a page of each study, and one of all inputs and cells. A population: what differs between conditions.

The page holds all it needs: it opens in any browser, without a network, and can be sent as one file.

Examples:

  cytodisk report out/

  cytodisk report out/ --cell 3

  cytodisk report all/ --resume     (the folder of a batch: a page for each study)
""",
    "export": """Write cells and windows of a study for Fiji, QuPath, or SpatialData.

STUDY is the folder that cytodisk map or movie wrote. --to roi writes sets for ImageJ's ROI Manager
(outlines.zip, windows.zip, nuclei.zip), --to geojson cells.geojson for QuPath, --to spatialdata the folder
spatialdata.zarr with images, labels, shapes and tables for squidpy and napari-spatialdata.

Examples:

  cytodisk export out/ --to roi -o fiji/

  cytodisk export out/ --to roi,geojson -o fiji/ --cells 0,3 --frames 10:20

  cytodisk export out/ --to spatialdata -o scverse/

Exit code: 0 when done (cells without a map are told), 2 if a map or an image is gone, or a file is there.
""",
    "compare-windows": """Compare kinds of windows on your own masks: how many are empty, how regular.

MASKS is one mask, a stack of masks, or a label image, or a folder of those. With --movie it is a stack of
masks of one cell through time (or label images in which a label is a cell), and --signal what to sample.

Methods: newton (cytodisk's default map), newton-triangles (areas by triangle), harmonic (before
relaxation), advection (the paper's relaxation), edge (by distance from the edge, as is usual), rings (around
the deepest point, as CellProfiler's). A movie is compared by newton, harmonic and edge, if --methods does not
say otherwise.

With --nuclei the methods are newton (cytodisk's map of cell and nucleus), nucleus-rings (by the share of the
way from the edge to the nucleus, as CellProfiler's) and interpolated-rings (between both outlines).

Examples:

  cytodisk compare-windows masks.tif -o out/ --layers 12 --sectors 60 --workers 2

  cytodisk compare-windows masks.tif --movie --signal movie.ome.tif -o out/ --depth-px 10

  cytodisk compare-windows cells.tif --nuclei nuclei.tif -o out/ --layers 8 --nucleus-layers 3

Exit code: 0 when done (cells without a map have a row with the reason), 2 if no cell could be used, or a file
is damaged.

The paper's relaxation (advection) takes seconds a cell, and minutes for one of 50 000 pixels and more.
""",
    "check": """Say what is wrong with masks before a run, and how many can be used.

It says what the file was understood as, and a line for each kind of fault with the cells or frames that have
it. --all prints a line for every cell, or frame of a stack.

Exit code: 0 when all can be used (an image of a folder may be empty), 1 if any cannot, 2 if the file
cannot be read at all.

Examples:

  cytodisk check labels.tif

  cytodisk check masks.tif --signal movie.ome.tif --all
""",
    "info": "Print versions, and which optional parts are there.",
    "demo": "Simulate a moving cell with two signals, follow it, correlate, report, "
    """compare with the known answer.

Nothing is downloaded. OUT/input holds the simulated files, OUT/study the results, with report.html.
""",
}
