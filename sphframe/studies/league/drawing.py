"""Studies: the figures of the league table."""

import dataclasses
import io
import math
from collections.abc import Mapping

import numpy as np
import xarray as xr

from sphframe.analysis.figures import new_figure
from sphframe.studies.chapter import Picture
from sphframe.studies.drawing import picture, tidy

_PANELS = 3


def curves(name: str, results: Mapping[str, xr.Dataset]) -> Picture | None:
    """Draw the first variables of a benchmark with all methods, beside what is exact and what was measured.

    None if no run has them. What is exact is drawn as far as the longest run goes.
    """
    drawn = [result for result in results.values() if _variables(result)]
    if not drawn:
        return None
    first = max(drawn, key=lambda result: float(result.attrs["end"]))
    variables = _variables(first)[:_PANELS]
    from matplotlib import colormaps

    colours = dict(zip(sorted(results), [*colormaps["tab20"](range(20)), *colormaps["Set2"](range(8))], strict=False))
    columns = 3 * len(variables)
    figure = new_figure(4.2 * len(variables), 3.0 + 0.14 * math.ceil((len(results) + 1) / columns))
    panels = figure.subplots(1, len(variables), squeeze=False)[0]
    for axes, key in zip(panels, variables, strict=True):
        for method, result in results.items():
            if f"{key} measured" not in result:
                continue
            x, y = result[f"{key} at"].values, result[f"{key} measured"].values
            if result[f"{key} at"].attrs["kind"] == "time":
                axes.plot(x, y, color=colours.get(method, "grey"), linewidth=0.8, alpha=0.8, label=method)
            else:
                axes.plot(x, y, ".", color=colours.get(method, "grey"), markersize=1.5, alpha=0.5, label=method)
        exact = first[f"{key} exact"]
        axes.plot(first[f"{key} at"], exact, color="black", linewidth=1.2, label=first.attrs.get("label", "exact"))
        if f"{key} reference" in first:
            series = first[f"{key} reference"]
            axes.plot(first[f"{key} reference at"], series, "kx", markersize=2.5, label=series.attrs["label"])
        known = exact.values[np.isfinite(exact)]
        if len(known):
            low, high = float(known.min()), float(known.max())
            room = 0.5 * (high - low) or abs(high) or 1.0
            axes.set_ylim(low - room, high + room)
        tidy(axes, xlabel=_label(first[f"{key} at"]))
        axes.set_title(_label(exact), fontsize=9, loc="left")
    figure.legend(
        *panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=columns, fontsize=6, frameon=False
    )
    return _small(
        picture(
            f"{name}-curves", "All methods beside the exact solution; curves may leave the panel.", figure, raster=True
        )
    )


def particles(name: str, method: str, result: xr.Dataset, spacing: float) -> Picture:
    """Draw the particles of a run in their last frame, coloured by pressure, with the walls."""
    from matplotlib.collections import EllipseCollection

    position, pressure = result["position"].values, result["pressure"].values
    low, high = np.nanmin(position, axis=0), np.nanmax(position, axis=0)
    size = np.maximum(high - low, spacing)
    figure = new_figure(4.8, float(np.clip(4.8 * size[1] / size[0], 1.6, 5.0)) + 0.6)
    axes = figure.subplots()
    limits = np.nanpercentile(pressure, [1.0, 99.0])
    dots = EllipseCollection(
        [spacing], [spacing], [0.0], units="xy", offsets=position, transOffset=axes.transData, array=pressure
    )
    dots.set_clim(*limits)
    axes.add_collection(dots)
    walls = result["walls"].values
    axes.plot(*walls.T, color="black", linewidth=1.0)
    margin = 0.06 * size.max()
    axes.set(xlim=(low[0] - margin, high[0] + margin), ylim=(low[1] - margin, high[1] + margin), aspect="equal")
    figure.colorbar(dots, ax=axes, shrink=0.8, extend="both", label="pressure (Pa)")
    tidy(axes, xlabel="x (m)", ylabel="y (m)", grid=False)
    return _small(picture(f"{name}-particles", f"Last frame with {method}.", figure, raster=True))


def _small(drawn: Picture) -> Picture:
    """Return a picture with a palette of 96 colours, which takes a third of the space."""
    from PIL import Image

    content = io.BytesIO()
    with Image.open(io.BytesIO(drawn.content)) as image:
        image.convert("RGB").quantize(96).save(content, format="PNG", optimize=True)
    return dataclasses.replace(drawn, content=content.getvalue())


def _variables(result: xr.Dataset) -> list[str]:
    return [str(name).removesuffix(" exact") for name in result.data_vars if str(name).endswith(" exact")]


def _label(array: xr.DataArray) -> str:
    unit = array.attrs["units"]
    return f"{array.attrs['long_name']} ({unit})" if unit != "1" else str(array.attrs["long_name"])
