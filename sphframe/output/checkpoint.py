"""Output: checkpoints, from which a run that was stopped or killed continues to the same bits.

A checkpoint lies beside the output, ``run.nc.restart`` beside ``run.nc``: a ZIP archive, uncompressed, of raw arrays in
little-endian byte order, one member each, and ``checkpoint.json`` with their types and shapes and with the versions of
all that computed them. Its check sums tell a damaged one. It is data: nothing in it can execute.

It is written under another name, brought to the disk and then renamed: whatever happens, either the checkpoint before
or the new one is there. The output is brought to the disk first: a checkpoint never counts a frame that is not there.
"""

import importlib.metadata
import json
import platform
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from sphframe.errors import InputError
from sphframe.interfaces import ResumableRun
from sphframe.output.files import replaced_as_a_whole
from sphframe.output.provenance import distributions, software

if TYPE_CHECKING:
    from sphframe.cases import Case

__all__ = ["Checkpoint", "changed_versions", "checkpoint_path", "read_checkpoint", "write_checkpoint"]

_FORMAT = 2
_HEADER = "checkpoint.json"
_TYPES = {"f": "<f8", "i": "<i8"}


@dataclass(frozen=True)
class Checkpoint:
    """What a checkpoint holds: the ``state`` of the simulation, and of which run, made by which versions."""

    run_id: str
    time: float
    samples: int
    frames: int
    versions: Mapping[str, str]
    state: Mapping[str, NDArray[Any]]


def checkpoint_path(output: Path) -> Path:
    """Return the path of the checkpoint of a run whose output file is ``output``."""
    return output.with_name(f"{output.name}.restart")


def write_checkpoint(path: Path, simulation: ResumableRun, run_id: str) -> None:
    """Write a checkpoint of the present state of ``simulation`` to ``path``.

    Raises
    ------
    OSError: when it cannot be written; the previous one is intact.
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
    InputError: when it is missing, damaged, or written by another format of checkpoints.
    """
    damaged = f"{path} is not a readable checkpoint of sphframe: it is foreign or damaged; copy it again, or run again"
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


def _array(content: bytes, kind: str, shape: list[int]) -> NDArray[Any]:
    if kind not in _TYPES.values():
        raise ValueError(kind)
    return np.frombuffer(content, dtype=kind).reshape(shape).copy()


def changed_versions(checkpoint: Checkpoint, case: "Case") -> list[str]:
    """Return what is not the version that wrote ``checkpoint``, as texts ``numpy 2.1.0, now 2.2.0``."""
    before, now = checkpoint.versions, _versions(case)
    return [
        f"{name} {before.get(name, 'absent')}, now {now.get(name, 'absent')}"
        for name in sorted({*before, *now})
        if before.get(name) != now.get(name)
    ]


def _versions(case: "Case") -> dict[str, str]:
    """Versions of all that the bits of a result depend on."""
    return {
        **distributions(case),
        **software(),
        "llvmlite": importlib.metadata.version("llvmlite"),
        "processor": platform.machine(),
    }
