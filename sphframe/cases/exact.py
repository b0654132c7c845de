"""Cases: flows that are known exactly."""

from abc import abstractmethod
from typing import TYPE_CHECKING

import numpy as np

from sphframe.cases.case import Case

if TYPE_CHECKING:
    import xarray as xr


class ExactCase(Case):
    """A case with an exact solution, ``dataset.sph.exact``, with which its runs are compared.

    The summary of a run then holds its ``errors``, and its picture shows run and solution.
    """

    @abstractmethod
    def exact(self, dataset: "xr.Dataset") -> "xr.Dataset":
        """Return the solution: one-dimensional variables with the units and long names of what they are.

        Parameters
        ----------
        dataset: a run of this case, with at least one frame and sample.
        """

    def measured(self, dataset: "xr.Dataset") -> "xr.Dataset":
        """Return what the run has in place of :meth:`exact`: the same variables on the same coordinates.

        By default these are variables of the dataset with the same names.
        """
        return dataset[list(self.exact(dataset).data_vars)]

    def errors(self, dataset: "xr.Dataset") -> dict[str, float]:
        """Return the errors of the run by name, each over a scale of its own.

        By default this is the RMS difference of each variable over the largest exact value.
        """
        exact, measured = self.exact(dataset), self.measured(dataset)
        return {
            str(name): float(np.sqrt(((measured[name] - value) ** 2).mean()) / np.abs(value).max())
            for name, value in exact.data_vars.items()
        }
