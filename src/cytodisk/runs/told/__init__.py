"""What runs tell at their end, in lines: for the console and for the widgets of napari."""
