"""Matplotlib figures of cells, their disks and their windows: functions take an Axes and return artists."""
