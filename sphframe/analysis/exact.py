"""Analysis: a run beside the exact solution of its case."""

import json
import sys
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from sphframe.analysis.figures import line_style, plain, printed_unit, tidy
from sphframe.analysis.scales import dimensional
from sphframe.cases import Case, ExactCase
from sphframe.errors import InputError, PluginError
from sphframe.registry import is_address, load

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def exact_case(dataset: xr.Dataset) -> ExactCase | None:
    """Return the case of a run with a frame and a sample, if it knows the exact solution; else None."""
    case = case_that_ran(dataset) if dataset.sizes["time"] and dataset.sizes["probe_time"] else None
    return case if isinstance(case, ExactCase) else None


def case_that_ran(dataset: xr.Dataset) -> Case | None:
    """Return the case of a run; None if it is not installed.

    A case given as ``module:Class`` is found if its module has been imported: a file never makes sphframe import code.
    """
    name = dataset.attrs["case_name"]
    if is_address(name):
        module, _, attribute = name.partition(":")
        model: Any = getattr(sys.modules.get(module), attribute, None)
    else:
        try:
            model = load("cases", name)
        except PluginError:  # it is not installed here
            return None
    if not (isinstance(model, type) and issubclass(model, Case)):
        return None
    return model(**json.loads(dataset.attrs["case_parameters"]))


def with_exact_solution(dataset: xr.Dataset) -> ExactCase:
    """Return the case of a run, as above.

    Raises
    ------
    InputError
        it knows no exact solution, or the run has no frame or sample.
    """
    case = exact_case(dataset)
    if case is None:
        raise InputError(
            f"the case {dataset.attrs['case_name']} has no exact solution, or its run has no frame or sample yet"
        )
    return case


def references_by_name(
    references: Iterable[xr.DataArray], dataset: xr.Dataset, names: Iterable[Any]
) -> dict[str, list[xr.DataArray]]:
    """Return the series that are to be seen with each of ``names``, of probes or variables, in Pa over s.

    A series of ``references``, p/(rho0 g H) over t sqrt(g/H), belongs to the name that its own begins with, and is
    called by the rest.
    """
    found: dict[str, list[xr.DataArray]] = {str(name): [] for name in names}
    for series in references:
        name, _, label = str(series.name).partition(" ")
        if name in found:
            found[name].append(dimensional(series, dataset).rename(label))
    return found


def draw_exact(
    axes: "list[Axes]", dataset: xr.Dataset, case: ExactCase, exact: xr.Dataset, references: Sequence[xr.DataArray] = ()
) -> None:
    """Draw each variable of the run as points and its ``exact`` solution as a line, one on each of ``axes``.

    Those of ``references`` that belong to a variable, see above, are drawn with it.
    """
    measured, label_of_exact = case.measured(dataset), exact.attrs.get("label", "exact")
    own = references_by_name(references, dataset, exact.data_vars)
    for panel, (name, value) in zip(axes, exact.data_vars.items(), strict=False):
        (dim,) = value.dims
        x, order = value[dim].values, np.argsort(value[dim].values, kind="stable")
        panel.plot(x, measured[name].values, ".", markersize=2.5, label="run")
        panel.plot(x[order], value.values[order], color="black", linewidth=1.0, label=label_of_exact)
        for series in own[str(name)]:
            style: dict[str, Any] = {"color": line_style(1)["color"], "markersize": 2.0}
            panel.plot(series[series.dims[0]].values, series.values, "s", label=plain(str(series.name)), **style)
        for set_label, array in ((panel.set_xlabel, value[dim]), (panel.set_ylabel, value)):
            label, unit = array.attrs.get("long_name", str(array.name)), array.attrs.get("units", "1")
            set_label(plain(label if unit == "1" else f"{label} ({printed_unit(unit)})"), fontsize=10)
        panel.legend(fontsize=9, frameon=False)
        tidy(panel)
