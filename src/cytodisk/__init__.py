"""cytodisk: any cell, any moment, one disk.

The stub beside this file lists the public names by what a user does; each is loaded when it is first used.
"""

from pathlib import Path

import lazy_loader

from cytodisk.kernel_cache import keep_kernels

__version__ = "0.2.0"

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)

keep_kernels(Path(__file__).parent)
