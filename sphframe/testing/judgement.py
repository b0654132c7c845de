"""Testing: a method judged on the particles of a file, and at the wall particles that belong to them.

A particle is left out, the method computes weights at its position from its neighbours, and the pressure
sum_j Phi_j p_j is compared with the stored one. No walls are needed, so that particles of any program will do. At a
wall particle x_G the pressure is sum_j Phi_j [p_j + b.(x_G - x_j)], b = rho g, with weights at its mirror point or, for
methods that are evaluated there and where the file has no mirror points, at the wall particle itself.
"""

from dataclasses import dataclass

import numpy as np

from sphframe.arrays import Array, BoolArray, IntArray
from sphframe.interfaces import BoundaryInterpolator, EvaluationPoint, Kernel, Status
from sphframe.registry import create
from sphframe.testing.evaluation import evaluator
from sphframe.testing.neighbourhoods import Cloud
from sphframe.testing.particle_files import Particles, WallPoints

FULL = 0.9
"""filling sum_j V_j W_j, over the largest one, above which a particle is in the midst of the fluid"""


@dataclass(frozen=True)
class Judgement:
    """Results of a method for m particles that were left out, or m wall particles.

    Attributes
    ----------
    status
        (m,), see :class:`sphframe.Status`; DRY without neighbours.
    neighbours
        (m,), their number.
    total
        (m,), sum_j Phi_j.
    gain
        (m,), the sum of the absolute weights, by which errors of the values are magnified at most.
    noise
        (m,), the root of the sum of the squares of the weights, the factor for independent errors.
    error
        (m,), interpolated less stored pressure, Pa.
    inside
        (m,), whether the place is in the midst of the fluid.
    scale
        root mean square of the stored pressures, Pa.
    """

    status: IntArray
    neighbours: IntArray
    total: Array
    gain: Array
    noise: Array
    error: Array
    inside: BoolArray
    scale: float

    def share(self, status: Status) -> float:
        """Return the share of particles with ``status``."""
        return float(np.mean(self.status == int(status)))

    def distance(self, where: BoolArray | None = None) -> float:
        """Return the root mean square of the error over that of the pressure, of the particles ``where`` true."""
        chosen = self.error if where is None else self.error[where]
        return float(np.sqrt(np.mean(chosen**2)) / self.scale) if len(chosen) else float("nan")


def judge(
    method: BoundaryInterpolator,
    particles: Particles,
    *,
    kernel: str | Kernel = "gaussian",
    smoothing_length: float | None = None,
    sample: int = 2000,
) -> Judgement:
    """Judge ``method`` on up to ``sample`` of the ``particles``, evenly chosen.

    ``smoothing_length`` h, m, is by default that of :meth:`Particles.length`.
    """
    numbers = _evenly(len(particles.position), sample)
    places = particles.position[numbers]
    return _judged(method, particles, kernel, smoothing_length, places, particles.pressure[numbers], left_out=numbers)


def judge_walls(
    method: BoundaryInterpolator,
    particles: Particles,
    walls: WallPoints,
    *,
    kernel: str | Kernel = "gaussian",
    smoothing_length: float | None = None,
    sample: int = 2000,
) -> Judgement:
    """Judge ``method`` at up to ``sample`` of the wall particles, evenly chosen, as :func:`judge` does.

    The status is DRY where no particle is within the support of the place at which the method is evaluated.
    """
    numbers = _evenly(len(walls.position), sample)
    ghost, mirror, where = walls.position[numbers], walls.mirror[numbers], method.traits.evaluation_point
    lift = ghost - mirror if where.takes_lift else None
    if lift is not None and where is EvaluationPoint.DIRECTED:
        lift = lift / np.maximum(np.linalg.norm(lift, axis=1, keepdims=True), 1e-300)
    places = ghost if where.at_ghost else mirror
    values = walls.pressure[numbers]
    return _judged(
        method, particles, kernel, smoothing_length, places, values, lift=lift, ghost=ghost, force=walls.force
    )


def _evenly(count: int, sample: int) -> IntArray:
    return np.unique(np.linspace(0, count - 1, min(sample, count)).astype(int))


def _judged(
    method: BoundaryInterpolator,
    particles: Particles,
    kernel: str | Kernel,
    smoothing_length: float | None,
    places: Array,
    stored: Array,
    *,
    left_out: IntArray | None = None,
    lift: Array | None = None,
    ghost: Array | None = None,
    force: Array | None = None,
) -> Judgement:
    from scipy.spatial import cKDTree

    chosen = create("kernels", kernel) if isinstance(kernel, str) else kernel
    h = particles.length(smoothing_length)
    dim, support = particles.position.shape[1], chosen.support * h
    run, value = evaluator(method, dim, chosen), chosen.value_function()
    tree = cKDTree(particles.position)
    rows = []
    for k, place in enumerate(places):
        near = np.array([j for j in tree.query_ball_point(place, support) if left_out is None or j != left_out[k]], int)
        offsets = particles.position[near] - place
        inside = np.linalg.norm(offsets, axis=1) < support if len(near) else np.zeros(0, bool)
        near, offsets = near[inside], offsets[inside]
        if not len(near):
            rows.append((int(Status.DRY), 0, 0.0, 0.0, 0.0, -stored[k], 0.0))
            continue
        cloud = Cloud(offsets, particles.volume[near], support, None if lift is None else lift[k])
        outcome = run(cloud)
        phi, pressure = outcome.weights, particles.pressure[near]
        if ghost is not None and force is not None:
            pressure = pressure + (ghost[k] - particles.position[near]) @ force
        full = float(np.dot([value(r / h) for r in cloud.distances.tolist()], cloud.volumes))
        sizes = float(np.abs(phi).sum()), float(np.sqrt(np.sum(phi**2)))
        rows.append((outcome.status, len(near), float(phi.sum()), *sizes, float(phi @ pressure) - stored[k], full))
    status, near_by, total, gain, noise, error, filling = np.array(rows).T
    return Judgement(
        status.astype(int),
        near_by.astype(int),
        total,
        gain,
        noise,
        error,
        filling > FULL * np.quantile(filling, 0.95),
        float(np.sqrt(np.mean(particles.pressure**2))) or 1.0,
    )
