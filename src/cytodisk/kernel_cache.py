"""Where compiled kernels are kept."""

import atexit
import os
import pickle
import shutil
import tempfile
import warnings
from contextlib import suppress
from pathlib import Path
from types import ModuleType

_OF_ONE_RUN = "cytodisk-kernels-"  # start of the name of a folder of kernels that goes when its run ends


def keep_kernels(package: Path) -> None:
    """See to it that compiled kernels can be kept, else Numba refuses to compile any.

    Numba keeps them beside the code or, where that cannot be written, in the user's folder for caches.
    Without either they go to a folder of this run, which the processes it starts share.

    Parameters
    ----------
    package : Path
        Folder of the code.

    Warns
    -----
    UserWarning
        They cannot be kept for the next start.
    """
    if os.environ.get("NUMBA_CACHE_DIR") or _can_be_written(package / "__pycache__"):
        return
    from numba.misc.appdirs import user_cache_dir

    own = Path(user_cache_dir("numba"))  # type: ignore[no-untyped-call]
    if _can_be_written(own):
        return
    folder = tempfile.mkdtemp(prefix=_OF_ONE_RUN)
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    os.environ["NUMBA_CACHE_DIR"] = folder
    import numba

    numba.config.CACHE_DIR = folder  # type: ignore[attr-defined]
    warnings.warn(
        f"compiled kernels cannot be kept, as neither {package} nor {own} can be written: every start "
        "compiles them anew, which takes 15 to 30 seconds. Set the environment variable "
        "NUMBA_CACHE_DIR to a folder that can be written",
        stacklevel=2,
    )


def keeps_kernels() -> bool:
    """Whether compiled kernels stay for the next start; see `keep_kernels`."""
    return not Path(os.environ.get("NUMBA_CACHE_DIR", "")).name.startswith(_OF_ONE_RUN)


def has_kernels(module: ModuleType) -> bool:
    """Whether kernels of a module were compiled before, by the same Numba and from the code as it is.

    Parameters
    ----------
    module : module
        Has kernels that Numba keeps.

    Returns
    -------
    bool
        True where Numba compiles nothing (`NUMBA_DISABLE_JIT`).
    """
    from numba import __version__
    from numba.core.dispatcher import Dispatcher

    kernels = [value for value in vars(module).values() if isinstance(value, Dispatcher)]
    own = [kernel for kernel in kernels if kernel.py_func.__module__ == module.__name__]
    if not own:
        return True
    name, written = module.__name__.rpartition(".")[2], Path(str(module.__file__)).stat().st_mtime
    for index in Path(own[0].stats.cache_path or ".").glob(f"{name}.*.nbi"):
        with suppress(OSError, pickle.UnpicklingError, EOFError), index.open("rb") as file:
            if os.fstat(file.fileno()).st_mtime >= written and pickle.load(file) == __version__:
                return True
    return False


def _can_be_written(folder: Path) -> bool:
    """Whether files can be made in a folder, tried as Numba does: rights alone do not tell."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return True
    except OSError:
        return False
