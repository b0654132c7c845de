"""Output: whether a dataset is that of a run: one check against the schema, so that no reader has to make its own."""

import json
from typing import TYPE_CHECKING, Any

import numpy as np

from sphframe.output.schema import VARIABLES, RunStatus, Variable

if TYPE_CHECKING:
    import xarray as xr

_TEXTS = ("title", "source", "case_name", "case_parameters", "components", "distributions", "software", "created")
_NUMBERS = ("particle_spacing", "smoothing_length", "sound_speed", "reference_density", "gravity", "depth")
_POINTS = ("gravity_vector", "domain_lower", "domain_upper")
_USED_PARAMETERS: dict[str, tuple[type, ...]] = {
    "until": (float, int),
    "wall_treatment": (dict,),
    "interpolator": (dict,),
    "hydrostatic_lift": (str,),
    "gravity": (float, int, list),
}
_INDEXED = {
    **dict.fromkeys(("part_wall", "outline_wall", "triangle_wall"), "wall"),
    **dict.fromkeys(("wall_body", "probe_body", "gauge_body", "ghost_body"), "body"),
}
"""variables that hold indices along a dimension; of a body also -1"""
_STATUS = ("run_status", "run_message")
_KINDS = {"f8": "f", "i4": "iuf", "text": "OSTU"}


def fault_of(dataset: "xr.Dataset") -> str:
    """Return what a dataset lacks, compared with the schema, to be that of a run; an empty text if it lacks nothing."""
    try:
        return _of_attributes(dataset.attrs) or _of_variables(dataset) or _of_values(dataset)
    except (OSError, RuntimeError, ValueError, UnicodeError) as error:  # values that cannot be read or decoded
        return f"values that cannot be read ({error})"


def _of_attributes(attributes: dict[str, Any]) -> str:
    for name in _TEXTS:
        if not isinstance(attributes.get(name), str):
            return f"no text as attribute {name}"
    dimension = np.asarray(attributes.get("dimension"))
    if dimension.dtype.kind not in "iu" or dimension.size != 1 or int(dimension) not in (2, 3):
        return "an attribute dimension that is not 2 or 3"
    for names, size in ((_NUMBERS, 1), (_POINTS, int(dimension))):
        for name in names:
            value = np.asarray(attributes.get(name))
            if value.dtype.kind not in "fiu" or value.size != size or not np.all(np.isfinite(value)):
                return f"an attribute {name} that is not {size} finite number{'s' * (size > 1)}"
    try:
        parameters = json.loads(attributes["case_parameters"])
    except ValueError:
        return "case_parameters that are no JSON"
    if not isinstance(parameters, dict):
        return "case_parameters that are no table"
    for name, kinds in _USED_PARAMETERS.items():
        given: Any = parameters.get(name)
        if not isinstance(given, kinds) or (isinstance(given, dict) and not isinstance(given.get("name"), str)):
            return f"no {name}, or one of another type, among its case_parameters"
    return ""


def _of_variables(dataset: "xr.Dataset") -> str:
    dimension = int(dataset.attrs["dimension"])
    optional = {"turns", *_STATUS} if "completed" in dataset.attrs else {"turns"}  # prepared and saved before
    optional |= {"probe_z", "gauge_y"} if dimension == 2 else set()
    for name in ("space", "particle", "probe_time", "time", "status"):
        if name not in dataset.sizes:
            return f"no dimension {name}"
    if dataset.sizes["space"] != dimension or (dataset.sizes.get("wall") and "outline" not in dataset.sizes):
        return "dimensions that contradict each other"
    for name, variable in VARIABLES.items():
        dimensions = dimensions_of(name, variable, dimension)
        if name not in dataset.variables:
            if name not in optional and set(dimensions) <= set(dataset.sizes):
                return f"no variable {name}"
        elif dataset[name].dims != dimensions or dataset[name].dtype.kind not in _KINDS[variable.type]:
            return f"a variable {name} of other dimensions or of another type"
    return ""


def _of_values(dataset: "xr.Dataset") -> str:
    if "run_status" in dataset and int(dataset["run_status"]) not in set(RunStatus):
        return "an unknown run_status"
    for name in ("space", "probe", "gauge", "wall", "part", "body", "status"):
        if name in dataset and len(set(map(str, dataset[name].values.tolist()))) < dataset.sizes[name]:
            return f"two equal names along {name}"
    for name, counted in _INDEXED.items():
        indices = dataset[name].values if name in dataset else np.zeros(0)
        lowest = -1 if counted == "body" else 0
        if np.any((indices < lowest) | (indices >= dataset.sizes.get(counted, 0))):
            return f"indices in {name} of what is not there"
    if "outline" in dataset.sizes:
        counts = dataset["outline_node_count"].values
        if np.any(counts < 0) or counts.sum() != dataset.sizes["node"]:
            return "lines of other lengths than its nodes"
    for name in ("time", "probe_time"):
        times = dataset[name].values
        times = times[: np.isfinite(times).sum()] if name == "probe_time" else times
        if not np.all(np.isfinite(times)) or np.any(np.diff(times) < 0.0):
            return f"a {name} that does not increase"
    return ""


def dimensions_of(name: str, variable: Variable, dimension: int) -> tuple[str, ...]:
    """Return the dimensions of a variable of the schema in a run of 2 or 3 dimensions."""
    turning = "_moment" in name or name.startswith("body_ang")
    return variable.dimensions[:-1] if turning and dimension == 2 else variable.dimensions  # scalars in 2-D
