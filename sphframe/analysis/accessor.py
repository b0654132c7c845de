"""Analysis: the functions of this room as methods of a dataset, ``dataset.sph``."""

from functools import cached_property
from typing import Any

import xarray as xr
from numpy.typing import ArrayLike

from sphframe.analysis import fields, plots, probes, scales, water
from sphframe.analysis.exact import with_exact_solution
from sphframe.analysis.series import series_error
from sphframe.analysis.summary import summary
from sphframe.output.reader import prepared


class SphAccessor:
    """Analysis of a run's dataset: ``dataset.sph``, however xarray has opened it.

    Examples
    --------
    ``dataset.sph.at(0.5).pressure``, ``dataset.sph.to_grid("speed", 0.5).plot()``, ``dataset.sph.plot("run.png")``
    """

    def __init__(self, dataset: xr.Dataset) -> None:
        self._given = dataset

    @cached_property
    def _dataset(self) -> xr.Dataset:
        return prepared(self._given)

    @property
    def pressure_scale(self) -> float:
        """rho0 g H, in Pa."""
        return scales.pressure_scale(self._dataset)

    @property
    def time_scale(self) -> float:
        """sqrt(H/g), in s."""
        return scales.time_scale(self._dataset)

    def summary(self) -> dict[str, Any]:
        """See :func:`sphframe.analysis.summary`."""
        return summary(self._dataset)

    @property
    def exact(self) -> xr.Dataset:
        """The exact solution of the case, see :meth:`sphframe.cases.ExactCase.exact`."""
        return with_exact_solution(self._dataset).exact(self._dataset)

    @property
    def measured(self) -> xr.Dataset:
        """What the run has in place of :attr:`exact`."""
        return with_exact_solution(self._dataset).measured(self._dataset)

    def at(self, time: float | None = None) -> xr.Dataset:
        """Return the frame nearest to ``time`` (s; by default the last), with one value a particle in each variable.

        The components of vectors are ``x``, ``y``, ``velocity_x`` and so on, and ``speed`` is added: so
        ``dataset.sph.at(0.5).to_dataframe()`` has one row a particle. See :func:`sphframe.analysis.particles_at`.
        """
        return fields.by_components(fields.particles_at(self._dataset, time))

    def free_surface(self, time: float | None = None, *, resolution: float | None = None) -> xr.DataArray:
        """See :func:`sphframe.analysis.free_surface`."""
        return fields.free_surface(self._dataset, time, resolution=resolution)

    def water_surface(self, time: float | None = None) -> water.WaterSurface:
        """See :func:`sphframe.analysis.water_surface`."""
        return water.water_surface(self._dataset, time)

    def to_grid(
        self, field: str = "pressure", time: float | None = None, *, resolution: float | None = None
    ) -> xr.DataArray:
        """See :func:`sphframe.analysis.to_grid`."""
        return fields.to_grid(self._dataset, field, time, resolution=resolution)

    def probe_statistics(
        self, *, start: float | None = None, stop: float | None = None, expected: ArrayLike | None = None
    ) -> xr.Dataset:
        """See :func:`sphframe.analysis.probe_statistics`."""
        return probes.probe_statistics(self._dataset, start=start, stop=stop, expected=expected)

    def dimensionless(self, name: str) -> xr.DataArray:
        """Return a sampled series over t sqrt(g/H), pressures divided by rho0 g H and lengths by H."""
        series = self._dataset[name]
        scale = {"Pa": self.pressure_scale, "m": float(self._dataset.attrs["depth"])}.get(series.attrs["units"], 1.0)
        scaled = series / scale
        scaled = scaled.assign_coords(probe_time=self._dataset["probe_time"] / self.time_scale)
        scaled.attrs = {**series.attrs, "units": "1" if scale != 1.0 else series.attrs["units"]}
        scaled["probe_time"].attrs = {"units": "1", "long_name": "t sqrt(g/H)"}
        return scaled

    def error(self, name: str, reference: xr.DataArray, **selection: Any) -> dict[str, float]:
        """Compare a dimensionless series with a dimensionless reference, see :func:`series_error`.

        ``dataset.sph.error("probe_pressure", reference, probe="P1")``
        """
        return series_error(self.dimensionless(name).sel(selection), reference)

    def plot(self, path: Any = None, **options: Any) -> Any:
        """See :func:`sphframe.analysis.plot_run`."""
        return plots.plot_run(self._dataset, path, **options)
