"""QC flags of a study: what deserves a second look before its numbers are believed."""
