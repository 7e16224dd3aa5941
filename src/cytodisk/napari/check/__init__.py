"""What is wrong, by frame and cell, with a click that leads there."""
