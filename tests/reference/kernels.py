"""The renormalised Gaussian, cut off at 3 h."""

from dataclasses import dataclass
from math import erf, exp, pi
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
NORMALISATION = {2: 1.0 / (pi * (1.0 - 10.0 * exp(-9.0))), 3: 1.0 / (pi**1.5 * erf(3.0) - 42.0 * pi * exp(-9.0))}


@dataclass(frozen=True)
class Gaussian:
    """W = N / h^dim [exp(-q^2) - exp(-9)], q = r/h < 3."""

    dim: int
    h: float

    @property
    def support(self) -> float:
        """R."""
        return 3.0 * self.h

    def value(self, r: Any) -> Array:
        """W."""
        height = NORMALISATION[self.dim] / self.h**self.dim
        return np.where(r < self.support, height * (np.exp(-((r / self.h) ** 2)) - np.exp(-9.0)), 0.0)

    def gradient(self, x_ji: Array) -> Array:
        """grad_i W_ij."""
        q2 = np.sum(x_ji**2, axis=-1, keepdims=True) / self.h**2
        slope = 2.0 * NORMALISATION[self.dim] / self.h ** (self.dim + 2) * np.exp(-q2)
        return np.where(q2 < 9.0, slope, 0.0) * x_ji
