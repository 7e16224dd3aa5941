"""Boundary through time: rigid registration, trackers, temporal maps, edge velocity."""
