"""A random cloud with ghosts, its neighbour lists by brute force, and the loops compiled for it."""

from dataclasses import dataclass, field

import numpy as np

from sphframe.boundary.wall_arrays import WallArrays
from sphframe.compiled import LANES, specialise
from sphframe.interfaces import CompiledKernel
from sphframe.kernels import compiled_kernel
from sphframe.kernels.gaussian import RenormalisedGaussian
from sphframe.kernels.wendland import WendlandC2
from sphframe.particles import Columns
from sphframe.physics import LoopParameters, fluid_sums, with_body_force

KERNELS = {"gaussian": RenormalisedGaussian(), "wendland-c2": WendlandC2()}


@dataclass
class Cloud:
    dim: int
    rows: np.ndarray
    fluid_count: int
    kernel: CompiledKernel
    h: float
    lists: np.ndarray
    fluid_counts: np.ndarray
    ghost_counts: np.ndarray
    morris: bool = False
    shares: np.ndarray = field(default_factory=lambda: np.zeros((1, 1, LANES), np.uint8))

    @property
    def gradient_scale(self):
        return self.kernel.normalisation / self.h ** (self.dim + 2)

    def parameters(self, **numbers):
        """The loops' parameters, with ``numbers`` such as ``diffusion`` as given and zero otherwise."""
        zero = dict.fromkeys(["gravity", "density_diffusion", "artificial_viscosity"], 0.0)
        of_case = LoopParameters.of(
            self.kernel, self.dim, smoothing_length=self.h, reference_density=1000.0, sound_speed=40.0, **zero
        )
        force, gradient = numbers.pop("force", (0.0, 0.0, 0.0)), numbers.pop("force_gradient", 9 * (0.0,))
        matrix = np.reshape(gradient, (3, 3))[: self.dim, : self.dim]
        return with_body_force(of_case._replace(**numbers), np.array(force[: self.dim]), matrix)

    def walls(self, seed=5):
        """Arrays of the ghosts with random normals, distances and velocities."""
        g = len(self.rows) - self.fluid_count
        random = np.random.default_rng(seed)
        normal = random.normal(size=(g, self.dim))
        normal /= np.linalg.norm(normal, axis=1)[:, None]
        vectors = [random.normal(size=(g, self.dim)) for _ in range(3)]
        return WallArrays(
            normal, random.uniform(0.02, 0.2, g), np.full(g, 0.05), np.tile(-np.eye(self.dim), (g, 1, 1)), vectors[0],
            1e4 * vectors[1], self.rows[self.fluid_count :, Columns.of(self.dim).volume].copy(), np.ones(g),
            vectors[2], np.full(g, 1000.0), self.rows[self.fluid_count :, : self.dim].copy(), np.zeros(g, np.int64),
        )  # fmt: skip

    def parts(self):
        return {
            "DIM": self.dim,
            "COLUMNS": Columns.of(self.dim),
            "SUPPORT": self.kernel.support,
            "GRADIENT": self.kernel.gradient_of_square,
            "MASKED": len(self.shares) > 1,
            "MORRIS": self.morris,
        }

    def grad_kernel(self, x_ji):
        """grad_i W_ij, (n, dim), from the offsets x_j - x_i, in plain NumPy."""
        r = np.linalg.norm(x_ji, axis=1)
        factor = np.array([self.kernel.gradient(q) if q < self.kernel.support else 0.0 for q in r / self.h])
        return -self.gradient_scale * factor[:, None] * x_ji

    def density_gradient(self):
        gradient = np.full((self.fluid_count, self.dim), np.nan)
        self._sum(False, gradient, np.zeros((self.fluid_count, 2 * self.dim + 1)))
        return gradient

    def rates(self, gradient, **numbers):
        """Velocity, acceleration and density rate, the latter with the given gradient."""
        rates = np.full((self.fluid_count, 2 * self.dim + 1), np.nan)
        self._sum(False, np.zeros_like(gradient), rates, **numbers)
        self._sum(True, gradient, rates, **numbers)
        return rates

    def _sum(self, continuity, gradient, rates, **numbers):
        specialise(fluid_sums, {**self.parts(), "CONTINUITY": continuity})(
            self.rows, self.lists, self.fluid_counts, self.ghost_counts, self.shares, self.parameters(**numbers),
            gradient, rates,
        )  # fmt: skip


def make_cloud(dim, seed=0, *, kernel="gaussian", cells=6, ghosts=True, jitter=0.3, spacing=0.1):
    """A jittered lattice; with ``ghosts``, its lowest two layers are ghosts."""
    random = np.random.default_rng(seed)
    axes = np.meshgrid(*[np.arange(cells) * spacing] * dim, indexing="ij")
    position = np.stack([a.ravel() for a in axes], axis=1)
    position = position + random.uniform(-jitter, jitter, position.shape) * spacing
    ghost = (position[:, -1] < 1.5 * spacing) if ghosts else np.zeros(len(position), bool)
    order = np.argsort(ghost, kind="stable")
    position, n = position[order], int((~ghost).sum())
    columns = Columns.of(dim)
    rows = columns.zeros(len(position))
    rows[:, columns.position] = position
    rows[:, columns.velocity] = random.normal(size=(len(position), dim))
    rows[:, columns.density] = 1000.0 + random.normal(size=len(position))
    rows[:, columns.pressure] = random.normal(size=len(position)) * 1000.0
    rows[:, columns.mass] = random.uniform(0.8, 1.2, len(position)) * 1000.0 * spacing**dim
    rows[:, columns.volume] = rows[:, columns.mass] / rows[:, columns.density]
    shape = KERNELS[kernel]
    h = 1.3 * spacing
    reach = 1.1 * shape.support * h
    fluid, counts, ghost_counts = [], [], []
    for first in range(0, n, LANES):
        members = position[first : min(first + LANES, n)]
        near = np.flatnonzero((np.linalg.norm(position[:, None] - members, axis=2) < reach).any(axis=1))
        fluid.append(near)  # fluid rows come first, so fluid neighbours do
        counts.append(int((near < n).sum()))
        ghost_counts.append(int((near >= n).sum()))
    lists = np.zeros((len(fluid), max(map(len, fluid))), np.uint32)
    for c, near in enumerate(fluid):
        lists[c, : len(near)] = near
    compiled = compiled_kernel(shape, dim)
    return Cloud(dim, rows, n, compiled, h, lists, np.array(counts, np.uint32), np.array(ghost_counts, np.uint32))
