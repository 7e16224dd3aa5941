"""`cytodisk compare-windows`: windows of several methods, measured."""
