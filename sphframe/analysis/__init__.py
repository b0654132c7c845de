"""Analysis: numbers and pictures from the dataset of a run. Importing it adds the accessor ``sph`` to datasets."""

import sphframe.output.xarray_backend  # noqa: F401  (registers the accessor, as xarray does when it opens a file)
from sphframe.analysis.accessor import SphAccessor
from sphframe.analysis.convergence import convergence_order, convergence_orders
from sphframe.analysis.export import export_csv, export_run, vtk_parts
from sphframe.analysis.fields import free_surface, particles_at, to_grid
from sphframe.analysis.films import animate_run
from sphframe.analysis.plots import plot_run
from sphframe.analysis.probes import probe_statistics
from sphframe.analysis.reference import read_reference_series, references_for
from sphframe.analysis.scales import pressure_scale, rest_pressure, time_scale
from sphframe.analysis.series import running_mean, series_error
from sphframe.analysis.summary import concerns, front_arrival, summary
from sphframe.analysis.wall_picture import plot_walls
from sphframe.analysis.water import WaterSurface, water_surface

__all__ = [
    "SphAccessor",
    "WaterSurface",
    "animate_run",
    "concerns",
    "convergence_order",
    "convergence_orders",
    "export_csv",
    "export_run",
    "free_surface",
    "front_arrival",
    "particles_at",
    "plot_run",
    "plot_walls",
    "pressure_scale",
    "probe_statistics",
    "read_reference_series",
    "references_for",
    "rest_pressure",
    "running_mean",
    "series_error",
    "summary",
    "time_scale",
    "to_grid",
    "vtk_parts",
    "water_surface",
]
