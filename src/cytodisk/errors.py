"""Every error a user can cause. A message names the argument, what came and what to do.

All inherit `CytodiskError`, which is a `ValueError`; a leaf also inherits the built-in that a caller
would catch for such a fault. `OSError` stands first, because nothing but its own `__new__` can make one, and
libraries that unpickle errors (Dask's tblib) call that of the first base.
"""

from typing import Self, TypeVar


class CytodiskError(ValueError):
    """Base of all errors that cytodisk raises on purpose."""


class MaskError(CytodiskError):
    """The mask cannot be used: wrong type or shape, empty, or against a policy."""


class EmptyMaskError(MaskError):
    """No pixel of the mask or label image belongs to a cell."""


class NucleusError(MaskError):
    """The nucleus cannot be used with its cell: wrong shape, empty, several, outside, or at the edge."""


class SignalError(CytodiskError):
    """The signal does not fit the mask, or is not an image."""


class WindowError(CytodiskError):
    """The window grid or a request on it makes no sense."""


class ParameterError(CytodiskError):
    """A parameter is out of its range or unknown."""


class PopulationError(CytodiskError):
    """Cells, conditions or experiments cannot be put together or compared."""


class MapError(CytodiskError, RuntimeError):
    """The cell could not be mapped onto the disk with a valid certificate."""


class MeshError(MapError):
    """The outline could not be triangulated into a topological disk."""


class ReadError(OSError, CytodiskError):
    """A file is missing, is not an image, or is damaged."""


class StudyError(OSError, CytodiskError):
    """A study folder cannot be written, read or resumed."""


class WriteError(StudyError):
    """Results cannot be written, as on a full disk."""


class OtherRunError(StudyError):
    """A study folder holds the results of another run."""


class NoValuesError(PopulationError):
    """A cell gives nothing to a population; the message is the reason, for its row."""


class MissingPartError(ImportError, CytodiskError):
    """An optional part is not installed; the message names the `pip install` to type."""

    @classmethod
    def of(cls, needed_by: str, extra: str, fault: str = "is not installed") -> Self:
        """An error that says what needs a package, and how to install the extra that brings it.

        Parameters
        ----------
        needed_by : str
            As "the report page needs Jinja2".
        extra : str
            Of cytodisk, as "report".
        fault : str
            What is wrong with the package.
        """
        return cls(f"{needed_by}, which {fault}: {install_words(extra)}")


def install_words(extra: str) -> str:
    """What to type to install an optional part of cytodisk."""
    return f"type pip install 'cytodisk[{extra}]' (in a clone of cytodisk, pip install -e '.[{extra}]')"


Fault = TypeVar("Fault", bound=CytodiskError)


def as_data(fault: Fault) -> Fault:
    """An error to be kept and passed on, without what led to it: its message says that.

    A traceback would hold on to images, and not every library's errors can go to another process.
    """
    fault.__cause__ = fault.__context__ = fault.__traceback__ = None
    return fault


class StationarityWarning(UserWarning):
    """The level of many series drifts: what correlates may do so for no other reason."""


class PopulationWarning(UserWarning):
    """Cells were put together that differ in something that a reader should know."""


class DamagedPartWarning(UserWarning):
    """Part of the results of an earlier run is gone or damaged, and is made anew."""


class EarlierVersionWarning(UserWarning):
    """A file of an earlier version lacks something, or its values mean something else now."""


def words_of(error: BaseException) -> str:
    """What an error says, on one line; the name of its kind where it says nothing."""
    said = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
    words = " ".join(said.split()) or type(error).__name__
    return words if len(words) <= 200 else f"{words[:200]}…"
