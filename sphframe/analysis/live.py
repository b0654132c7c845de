"""Analysis: status and picture of a run in progress, for display while it is running."""

import io
import math
import os
import threading
import time
from dataclasses import dataclass, replace
from pathlib import Path

import xarray as xr

from sphframe.analysis.drawing import field_to_draw
from sphframe.analysis.figures import figure_class
from sphframe.analysis.plots import plot_run
from sphframe.analysis.scales import case_of, wall_method
from sphframe.analysis.summary import concerns
from sphframe.errors import SphframeError
from sphframe.output import open_dataset

_SHARE = 0.1  # largest share of the time that is spent on drawing, as the run needs the cores
_SILENCE = 60.0  # s without writing after which a run, which writes every second, is said to be silent


@dataclass(frozen=True)
class Look:
    """The status of a run at one moment.

    Attributes
    ----------
    status
        ``running``, ``completed``, ``stopped``, or ``unreadable`` while the file is missing or damaged.
    message
        why the run stopped, why its file cannot be read, that there is no frame yet, or that nothing was
        written for a long time; otherwise empty.
    facts
        data about the run as texts, by name.
    picture
        the latest frame, the series and the energies as a PNG; empty before the first frame. While the file
        cannot be read it is the last picture that was drawn.
    drawn
        number of pictures drawn so far.
    """

    status: str
    message: str
    facts: dict[str, str]
    picture: bytes = b""
    drawn: int = 0


class LiveRun:
    """Reads the file of a run repeatedly, from any thread, and draws a new picture when the run has progressed.

    Parameters
    ----------
    path
        the output file of a run, finished or in progress.
    field
        ``pressure``, ``speed`` or ``density``.

    Raises
    ------
    InputError
        the file is missing, damaged or of another program, the field is unknown, or matplotlib is missing.
    """

    def __init__(self, path: str | os.PathLike[str], *, field: str = "pressure") -> None:
        self.path = Path(path)
        self._field = field
        self._lock = threading.Lock()  # netCDF and matplotlib are not thread-safe
        self._look = Look("unreadable", "", {})
        self._shown: tuple[object, ...] = ()
        self._rest_until = 0.0
        field_to_draw(field)
        figure_class()
        open_dataset(path).close()

    @property
    def latest(self) -> Look:
        """The result of the last :meth:`look`; the file is not read."""
        return self._look

    def look(self) -> Look:
        """Read the file and return the status of the run; problems with the file are the ``message`` and not raised."""
        with self._lock:
            try:
                with open_dataset(self.path) as dataset:
                    self._look = self._seen(dataset)
            except SphframeError as error:
                self._look = replace(self._look, status="unreadable", message=str(error))
            except Exception as error:  # reading a file that is being replaced fails in many ways
                message = f"the file cannot be read: {type(error).__name__}: {error}"
                self._look = replace(self._look, status="unreadable", message=message)
            return self._look

    def _seen(self, dataset: xr.Dataset) -> Look:
        status = {"failed": "stopped"}.get(dataset.attrs["run_status"], dataset.attrs["run_status"])
        message = dataset.attrs["run_message"]
        silence = max(time.time() - self.path.stat().st_mtime, 0.0)
        picture, drawn = self._look.picture, self._look.drawn
        content = (dataset.attrs.get("run_id"), status, dataset.sizes["time"], dataset.sizes["probe_time"])
        if not dataset.sizes["time"] or not dataset.sizes["probe_time"]:
            message = message or "no frame yet: the picture comes with the first one"
        elif content != self._shown and (time.monotonic() >= self._rest_until or status != "running" or not picture):
            began = time.monotonic()
            picture, drawn = self._drawn(dataset), drawn + 1
            self._shown = content
            self._rest_until = time.monotonic() + (time.monotonic() - began) * (1.0 / _SHARE - 1.0)
        if status == "running" and silence > _SILENCE:
            message = (
                f"nothing was written for {silence:,.0f} s: if the run was killed,"
                f" sphframe resume {self.path.name} continues it from its last checkpoint"
            )
        facts = {**_facts(dataset, status), "written": f"{silence:,.0f} s ago"}
        return Look(status, message, facts, picture, drawn)

    def _drawn(self, dataset: xr.Dataset) -> bytes:
        picture = io.BytesIO()
        times = [float(dataset["time"][-1])]
        figure = plot_run(dataset, field=self._field, times=times, width=4.2)  # legible on a telephone
        figure.savefig(picture, format="png")
        return picture.getvalue()


def _facts(dataset: xr.Dataset, status: str) -> dict[str, str]:
    case = case_of(dataset)
    until = float(case["until"])
    facts = {
        "case": f"{dataset.attrs['case_name']}: {dataset.attrs['title']}",
        "method": wall_method(case),
        "particles": f"{dataset.sizes['particle']:,}, spacing {1e3 * dataset.attrs['particle_spacing']:g} mm",
        "time": f"0 of {until:.4g} s",
    }
    if dataset.sizes["probe_time"]:
        last = dataset.isel(probe_time=-1)
        now, step, elapsed = float(last["probe_time"]), int(last["step"]), float(last["wall_clock"])
        share = 100 if status == "completed" else math.floor(100.0 * min(now / until, 1.0) + 1e-9)
        facts["time"] = f"{now:.4g} of {until:.4g} s ({share} %), step {step:,}, {dataset.sizes['time']} frames"
        if elapsed > 0.0:
            facts["rate"] = f"{step / elapsed:,.0f} steps/s, {now / elapsed:.2g} simulated s per s"
            if status == "running" and now > 0.0:
                facts["rate"] += f", {elapsed * max(until / now - 1.0, 0.0):,.0f} s left"
        wrong = concerns(
            outside=int(dataset["particles_outside"].values.max(initial=0)),
            removed=int(last["particles_removed"]),
            densities=int(dataset["densities_outside"].max()),
            statuses=last["interpolation_status"],
        )
        facts["warnings"] = "; ".join(wrong) or "none"
    return facts
