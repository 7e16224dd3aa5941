"""The study folder: tables, arrays, maps, provenance."""
