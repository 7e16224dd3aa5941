"""Runs of the commands: parameters, files in, one way through a frame, a study out."""
