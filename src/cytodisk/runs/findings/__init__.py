"""What a study shows first, in sentences: for the report, the command line and the viewer."""
