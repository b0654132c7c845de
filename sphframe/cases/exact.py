"""Cases: flows that are known exactly."""

from abc import abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from sphframe.cases.case import Case

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True)
class Benchmark:
    """Runs of a case by which methods are ranked, see :func:`sphframe.studies.rank`.

    Attributes
    ----------
    score
        name of the error, in :meth:`ExactCase.errors`, by which methods are ranked.
    isolates
        what the case isolates, in a sentence.
    spacings
        particle spacings, m, the coarsest first; ``sphframe rank --quick`` uses the coarsest alone.
    parameters
        further parameters of the case.
    """

    score: str
    isolates: str
    spacings: tuple[float, ...]
    parameters: Mapping[str, Any] = field(default_factory=dict)


class ExactCase(Case):
    """A case with an exact solution, ``dataset.sph.exact``, with which its runs are compared.

    The summary of a run then holds its ``errors``, and its picture shows run and solution.
    """

    benchmarks: ClassVar[Mapping[str, Benchmark]] = {}
    """benchmarks of the league table that are runs of this case, by name"""

    @abstractmethod
    def exact(self, dataset: "xr.Dataset") -> "xr.Dataset":
        """Return the solution: one-dimensional variables with the units and long names of what they are.

        An attribute ``label`` names in pictures what is not exact, such as a published computation.

        Parameters
        ----------
        dataset
            a run of this case, with at least one frame and sample.
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
