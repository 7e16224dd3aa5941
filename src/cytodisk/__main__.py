"""`python -m cytodisk`."""

from cytodisk.cli import main

main()
