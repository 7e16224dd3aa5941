"""Whole figures written to files, and the report.

Functions that write take a study and return the paths of what they wrote.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
