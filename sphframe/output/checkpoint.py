"""Output: checkpoints, from which a run that was stopped or killed continues with the same bits.

A checkpoint is a file beside the output, ``run.nc.restart`` beside ``run.nc``. It is an uncompressed ZIP archive. It
contains one member for each array, in little-endian byte order, and ``checkpoint.json`` with the types and shapes of
the arrays and the versions of all software that computed them. The check sums of the archive reveal damage. The file
contains only data, nothing that could be executed.

A checkpoint is replaced as a whole (see :mod:`sphframe.output.files`). The output is synced to the disk before: a
checkpoint never counts a frame that the output does not contain.
"""

import importlib.metadata
import json
import platform
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from sphframe.arrays import AnyArray, Arrays
from sphframe.errors import InputError
from sphframe.interfaces import ResumableRun
from sphframe.output.files import replaced_as_a_whole
from sphframe.output.provenance import code, distributions, software

if TYPE_CHECKING:
    from sphframe.cases import Case

_FORMAT = 6
_HEADER = "checkpoint.json"
_TYPES = {"f": "<f8", "i": "<i8"}


@dataclass(frozen=True)
class Checkpoint:
    """The content of a checkpoint.

    Attributes
    ----------
    run_id
        identifies the run; the output file has the same one.
    time
        simulated time, s.
    samples, frames
        number of each that the output contains at this time.
    versions
        versions of the software that computed the state, by name.
    state
        arrays of the simulation's state, by name.
    """

    run_id: str
    time: float
    samples: int
    frames: int
    versions: Mapping[str, str]
    state: Arrays


def checkpoint_path(output: Path) -> Path:
    """Return the path of the checkpoint of a run whose output file is ``output``."""
    return output.with_name(f"{output.name}.restart")


def write_checkpoint(path: Path, simulation: ResumableRun, run_id: str) -> None:
    """Write a checkpoint of the present state of ``simulation`` to ``path``.

    Raises
    ------
    OSError
        when it cannot be written; the previous one is intact.
    """
    arrays = {name: np.asarray(a, _TYPES[a.dtype.kind], order="C") for name, a in simulation.state().items()}
    header = {
        "format": _FORMAT,
        "run_id": run_id,
        "time": simulation.time,
        "samples": simulation.samples,
        "frames": simulation.frames,
        "versions": _versions(simulation.case),
        "arrays": {name: [array.dtype.str, array.shape] for name, array in arrays.items()},
    }
    with replaced_as_a_whole(path) as draft, zipfile.ZipFile(draft, "w", zipfile.ZIP_STORED) as archive:
        archive.writestr(_HEADER, json.dumps(header))
        for name, array in arrays.items():
            archive.writestr(name, array.tobytes())


def read_checkpoint(path: Path) -> Checkpoint:
    """Read and check the checkpoint at ``path``.

    Raises
    ------
    InputError
        when it is missing or damaged, or its format is another one.
    """
    damaged = (
        f"{path} is not a readable checkpoint of sphframe: it was written by another program or is damaged; copy it"
        " again, or run again"
    )
    try:
        with zipfile.ZipFile(path) as archive:
            if any(member.compress_type != zipfile.ZIP_STORED for member in archive.infolist()):
                raise InputError(damaged)
            header = json.loads(archive.read(_HEADER))
            if header["format"] != _FORMAT:
                raise InputError(
                    f"{path} is a checkpoint of format {header['format']}, and this sphframe reads {_FORMAT}: continue"
                    f" with the sphframe that wrote it ({header.get('versions')})"
                )
            state = {name: _array(archive.read(name), kind, shape) for name, (kind, shape) in header["arrays"].items()}
        return Checkpoint(
            run_id=str(header["run_id"]),
            time=float(header["time"]),
            samples=int(header["samples"]),
            frames=int(header["frames"]),
            versions={str(name): str(version) for name, version in header["versions"].items()},
            state=state,
        )
    except FileNotFoundError:
        raise InputError(
            f"there is no checkpoint {path}: the run is complete, or ended before its first one; run the case again"
        ) from None
    except InputError:
        raise
    except OSError as error:
        raise InputError(f"cannot read the checkpoint {path}: {(error.strerror or str(error)).lower()}") from None
    except (zipfile.BadZipFile, KeyError, ValueError, TypeError, AttributeError, NotImplementedError, RuntimeError):
        raise InputError(damaged) from None  # RuntimeError: an encrypted member, or nested too deeply


def _array(content: bytes, kind: str, shape: list[int]) -> AnyArray:
    if kind not in _TYPES.values():
        raise ValueError(kind)
    return np.frombuffer(content, dtype=kind).reshape(shape).copy()


def changed_versions(checkpoint: Checkpoint, case: "Case") -> list[str]:
    """Return the versions that differ from those that wrote ``checkpoint``, as texts ``numpy 2.1.0, now 2.2.0``."""
    before, now = checkpoint.versions, _versions(case)
    return [
        f"{name} {before.get(name, 'absent')}, now {now.get(name, 'absent')}"
        for name in sorted({*before, *now})
        if before.get(name) != now.get(name)
    ]


def _versions(case: "Case") -> dict[str, str]:
    """Versions of all software on which the bits of a result depend."""
    return {
        **distributions(case),
        **code(case),
        **software(),
        "llvmlite": importlib.metadata.version("llvmlite"),
        "processor": platform.machine(),
    }
