"""The files of nuclei of a run, opened and checked against those of the masks."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from cytodisk.errors import CytodiskError, NucleusError, ReadError, as_data
from cytodisk.images.mask_files import MaskSource
from cytodisk.images.nuclei.frame_matches import FrameMatches
from cytodisk.images.nuclei.nuclei_files import NucleiFile, check_nuclei_file, match_source, open_nuclei
from cytodisk.images.nuclei.nuclei_parameters import NucleiFileParameters
from cytodisk.images.paired_files import NUCLEI, pair_files
from cytodisk.parameters import Parameters
from cytodisk.runs.cells.outline_sources import is_of_outlines
from cytodisk.scale import alike

_LOOKED_AT = 3  # files of a folder, for what would be wrong in all


@dataclass(frozen=True)
class NucleiInput:
    """The nuclei of a mask file, or the reason why there are none."""

    file: NucleiFile | None = None
    fault: CytodiskError | None = None

    def matches(self, source: MaskSource, frame: int) -> FrameMatches | CytodiskError:
        """The nuclei of the cells of a frame; a fault comes as data."""
        if self.file is None:
            return self.fault or NucleusError(f"{source.name} has no file of nuclei")
        try:
            return match_source(source, self.file, frame)
        except (ReadError, NucleusError) as fault:
            return as_data(fault)


def open_nuclei_of(source: MaskSource, nuclei: str | os.PathLike[str], parameters: Parameters) -> NucleiInput:
    """The file of nuclei that goes with one mask file.

    Parameters
    ----------
    source : MaskSource
    nuclei : path-like
    parameters : Parameters
        Those of the run; only what is said of nuclei counts.

    Returns
    -------
    NucleiInput

    Raises
    ------
    ReadError, NucleusError
        It is missing, damaged, no mask, of another size, the masks of the cells, or swapped with them.
    """
    file = _fitting(source, nuclei, parameters.part(NucleiFileParameters))
    found = NucleiInput(file)
    _refuse_cells([(source, found)], nuclei)
    return found


def _refuse_cells(some: Sequence[tuple[MaskSource, NucleiInput]], nuclei: str | os.PathLike[str]) -> None:
    """Raise NucleusError where all of some files of nuclei hold the cells, or the two are swapped."""
    usable = [(source, found) for source, found in some if source.file is not None and found.file is not None]
    faults = [found.matches(source, 0) for source, found in usable[:_LOOKED_AT]]
    if faults and all(isinstance(fault, NucleusError) for fault in faults):
        raise NucleusError(f"nuclei {nuclei}: {faults[0]}")


def open_paired_nuclei(
    sources: Sequence[MaskSource], nuclei: str | os.PathLike[str], parameters: Parameters
) -> dict[str, NucleiInput]:
    """The file of nuclei of each mask file of a folder, by its name.

    Parameters
    ----------
    sources : sequence of MaskSource
    nuclei : path-like
        A folder, or how names go on; see `pair_files`.
    parameters : Parameters
        As `open_nuclei_of` takes them.

    Returns
    -------
    dict of str to NucleiInput
        A file that cannot be used is kept with its fault.

    Raises
    ------
    ReadError, NucleusError
        No mask file has one that can be used.
    """
    paths, how = pair_files(sources, nuclei, NUCLEI), parameters.part(NucleiFileParameters)
    found = {source.name: _paired(source, path, how) for source, path in zip(sources, paths, strict=True)}
    if all(one.file is None for one in found.values()):
        faults = [one.fault for one in found.values() if one.fault is not None]
        raise NucleusError(f"nuclei {nuclei}: no file can be used: {faults[0] if faults else 'no mask can'}")
    _refuse_cells([(source, found[source.name]) for source in sources], nuclei)
    return found


def _paired(source: MaskSource, path: Path | CytodiskError, how: NucleiFileParameters) -> NucleiInput:
    if isinstance(path, CytodiskError):
        return NucleiInput(fault=path)
    try:
        return NucleiInput(_fitting(source, path, how))
    except (ReadError, NucleusError) as fault:
        return NucleiInput(fault=as_data(fault))


def _fitting(
    source: MaskSource, path: str | os.PathLike[str], how: NucleiFileParameters
) -> NucleiFile | None:
    if source.file is None:
        return None
    like = (source.file.n_frames, *source.file.image_shape) if is_of_outlines(path) else None
    found = open_nuclei(path, how, like)
    check_nuclei_file(source.file, found.file)
    return found


def with_scale(
    nuclei: Mapping[str, NucleiInput], pixel_size_um: float | None
) -> tuple[dict[str, NucleiInput], list[str]]:
    """Files of nuclei of a folder; one that says another pixel size than the run's becomes a fault.

    Parameters
    ----------
    nuclei : mapping of str to NucleiInput
        By name of the source.
    pixel_size_um : float or None

    Returns
    -------
    nuclei : dict of str to NucleiInput
    remarks : list of str
        How many there are.
    """
    checked = {name: _of_scale(found, pixel_size_um) for name, found in nuclei.items()}
    others = sum(found is not nuclei[name] for name, found in checked.items())
    words = (
        f"{others} of {len(nuclei)} files of nuclei have another pixel size than {pixel_size_um} µm: left out"
    )
    return checked, [words] if others else []


def _of_scale(found: NucleiInput, size: float | None) -> NucleiInput:
    own = None if found.file is None else found.file.file.scale.pixel_size_um
    if found.file is None or own is None or size is None or alike(own, size):
        return found
    return NucleiInput(
        fault=NucleusError(
            f"nuclei {found.file.file.path} have pixels of {own:g} µm, the run {size:g} µm: pass the right "
            "size for all, as --pixel-size"
        )
    )
