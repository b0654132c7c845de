"""Output: the accessor ``dataset.sph``, as xarray knows it once this module has been imported."""

from typing import Any

import xarray as xr


@xr.register_dataset_accessor("sph")  # type: ignore[no-untyped-call, untyped-decorator]
def accessor(dataset: xr.Dataset) -> Any:
    """Return the :class:`~sphframe.analysis.SphAccessor` of a ``dataset``."""
    from sphframe.analysis.accessor import SphAccessor

    return SphAccessor(dataset)
