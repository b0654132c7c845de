"""The operator of an interpolation method: compared with plain NumPy, and the checks of its input."""

import numpy as np
import pytest
from scipy.sparse import csr_array

from sphframe import DRY, OK, SINGULAR, TOO_FEW, InputError, ParticleCloud, create
from sphframe.boundary.operator import operator
from sphframe.kernels.gaussian import RenormalisedGaussian
from sphframe.testing.kernels import kernel_value

H = 0.013
SUPPORT = 3 * H


def lattice(dim=2, count=12, spacing=0.01, jitter=0.2, seed=1):
    rng = np.random.default_rng(seed)
    axes = np.meshgrid(*[np.arange(count) * spacing] * dim, indexing="ij")
    positions = np.stack(axes, -1).reshape(-1, dim) + rng.uniform(-jitter, jitter, (count**dim, dim)) * spacing
    volumes = spacing**dim * rng.uniform(0.8, 1.2, len(positions))
    points = rng.uniform(0.2, 0.8, (7, dim)) * count * spacing
    return positions, volumes, points


def neighbourhood(point, positions, volumes):
    """Members, offsets, distances, kernel values and volumes, by brute force."""
    offsets = positions - point
    distances = np.linalg.norm(offsets, axis=1)
    members = np.flatnonzero(distances < SUPPORT)
    values = kernel_value(RenormalisedGaussian(), distances[members], H, positions.shape[1])
    return members, offsets[members], distances[members], values, volumes[members]


def normalised(offsets, distances, values, volumes):
    return values * volumes / np.sum(values * volumes)


def shepard(offsets, distances, values, volumes):
    return distances**-2.0 / np.sum(distances**-2.0)


def improved_shepard(offsets, distances, values, volumes):
    s = distances / SUPPORT
    logarithm = 4.0 * (-(s**2) / (1.0 - s**2) - np.log(s))
    weights = np.exp(logarithm - logarithm.max())
    return weights / weights.sum()


def least_squares(degree):
    def weights(offsets, distances, values, volumes):
        x = offsets / H
        columns = [np.ones(len(x)), *x.T]
        if degree == 2:
            columns += [x[:, a] * x[:, b] for a in range(x.shape[1]) for b in range(a + 1)]
        root = np.sqrt(values * volumes)
        # the value at the point is the first coefficient of the weighted fit: the first row of the pseudo-inverse
        return np.linalg.pinv(root[:, None] * np.column_stack(columns))[0] * root

    return weights


def sfdi(coupled):
    def weights(offsets, distances, values, volumes):
        dim = offsets.shape[1]
        i = int(np.argmin(distances))
        phi = values / values.sum()
        moment = phi @ offsets
        r = offsets - offsets[i]
        length = np.linalg.norm(r, axis=1)
        length[i] = 1.0
        factor = kernel_value(RenormalisedGaussian(), length, H, dim) / length**2
        factor[i] = 0.0
        matrix = (factor[:, None] * r).T @ r
        if not coupled:
            matrix = np.diag(np.diag(matrix))
        b = factor * (r @ np.linalg.solve(matrix, moment))
        phi = phi - b
        phi[i] += b.sum()
        return phi

    return weights


METHODS = {
    "normalized": (create("interpolators", "normalized"), normalised),
    "shepard": (create("interpolators", "shepard"), shepard),
    "improved-shepard": (create("interpolators", "improved-shepard"), improved_shepard),
    "mls-linear": (create("interpolators", "mls-linear"), least_squares(1)),
    "mls-quadratic": (create("interpolators", "mls-quadratic"), least_squares(2)),
    "sfdi-coupled": (create("interpolators", "sfdi"), sfdi(True)),
    "sfdi-printed": (create("interpolators", "sfdi", form="printed"), sfdi(False)),
}


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("name", METHODS)
def test_agrees_with_plain_numpy(name, dim):
    method, reference = METHODS[name]
    positions, volumes, points = lattice(dim)
    matrix, statuses = operator(method, points, positions, volumes, smoothing_length=H)
    assert isinstance(matrix, csr_array)
    assert statuses.tolist() == [OK] * len(points)
    for row, point in enumerate(points):
        members, *rest = neighbourhood(point, positions, volumes)
        expected = np.zeros(len(positions))
        expected[members] = reference(*rest)
        np.testing.assert_allclose(matrix[[row]].toarray()[0], expected, atol=1e-12)
        assert sorted(matrix.indices[matrix.indptr[row] : matrix.indptr[row + 1]]) == members.tolist()


def test_mdbc_agrees_with_plain_numpy():
    method = create("interpolators", "mdbc")
    positions, volumes, points = lattice()
    lift = np.array([0.011, -0.007])
    matrix, _ = operator(method, points, positions, volumes, smoothing_length=H, lift=lift)
    for row, point in enumerate(points):
        members, offsets, distances, values, v = neighbourhood(point, positions, volumes)
        slope = -2.0 * np.exp(-((distances / H) ** 2))
        # grad W about the mirror point is -slope * offset, up to a factor that cancels
        left = np.column_stack([values, -slope[:, None] * offsets]) * v[:, None]
        right = np.column_stack([np.ones(len(members)), offsets])
        expected = left @ np.linalg.solve((left.T @ right).T, np.array([1.0, *lift]))
        np.testing.assert_allclose(matrix[[row]].toarray()[0][members], expected, atol=1e-12)


def test_mdbc_without_lift_is_exact_at_the_point_and_with_it_at_the_ghost():
    method = create("interpolators", "mdbc")
    positions, volumes, points = lattice()
    field = 3.0 + positions @ [2.0, -5.0]
    for lift in (np.zeros(2), np.array([0.02, 0.01])):
        matrix, _ = operator(method, points, positions, volumes, smoothing_length=H, lift=lift)
        np.testing.assert_allclose(matrix @ field, 3.0 + (points + lift) @ [2.0, -5.0], rtol=1e-12)


@pytest.mark.parametrize("name", METHODS)
def test_the_method_form_gives_the_same_matrix(name):
    method, _ = METHODS[name]
    positions, volumes, points = lattice()
    matrix, _ = operator(method, points, positions, volumes, smoothing_length=H)
    same = method.operator(points, ParticleCloud(positions, volumes, H))
    assert np.array_equal(matrix.toarray(), same.toarray())


def test_a_dry_point_has_an_empty_row():
    matrix, statuses = operator(METHODS["shepard"][0], [5.0, 5.0], [[0.0, 0.0]], 1.0, smoothing_length=1.0)
    assert statuses.tolist() == [DRY]
    assert matrix.nnz == 0
    matrix, statuses = operator(METHODS["shepard"][0], [5.0, 5.0], np.empty((0, 2)), 1.0, smoothing_length=1.0)
    assert (statuses.tolist(), matrix.shape) == ([DRY], (1, 0))


@pytest.mark.parametrize("fraction", [0.0, 1e-9, 0.3, 0.9, 0.9999, 1 - 1e-12])
@pytest.mark.parametrize("name", METHODS)
def test_a_lone_neighbour_gets_weight_one_anywhere_in_the_support(name, fraction):
    matrix, _ = operator(METHODS[name][0], [0.0, 0.0], [[fraction * SUPPORT, 0.0]], 1e-4, smoothing_length=H)
    assert matrix.toarray().tolist() == [[1.0]]


@pytest.mark.parametrize("name", ["shepard", "improved-shepard"])
def test_coincident_particles_share_the_weight(name):
    positions = [[0.0, 0.0], [0.01, 0.0], [0.0, 0.0], [0.0, 0.02]]
    matrix, statuses = operator(METHODS[name][0], [0.0, 0.0], positions, 1e-4, smoothing_length=H)
    assert matrix.toarray().tolist() == [[0.5, 0.0, 0.5, 0.0]]
    assert statuses.tolist() == [OK]


@pytest.mark.parametrize("name", ["shepard", "improved-shepard"])
def test_all_neighbours_at_the_cut_off_count_alike(name):
    angles = np.linspace(0.0, 6.0, 5)
    positions = (1 - 1e-15) * SUPPORT * np.column_stack([np.cos(angles), np.sin(angles)])
    matrix, _ = operator(METHODS[name][0], [0.0, 0.0], positions, 1e-4, smoothing_length=H)
    weights = matrix.toarray()[0]
    weights = weights[weights != 0]
    np.testing.assert_allclose(weights.sum(), 1.0, rtol=1e-14)


@pytest.mark.parametrize(
    ("name", "count", "status"),
    [
        ("mls-linear", 2, TOO_FEW),
        ("mls-quadratic", 5, TOO_FEW),
        ("sfdi-coupled", 2, TOO_FEW),
        ("sfdi-printed", 1, TOO_FEW),
    ],
)
def test_points_with_too_few_neighbours_use_the_fallback(name, count, status):
    positions = np.random.default_rng(3).uniform(-0.01, 0.01, (count, 2))
    matrix, statuses = operator(METHODS[name][0], [0.0, 0.0], positions, 1e-4, smoothing_length=H)
    average, _ = operator(METHODS["normalized"][0], [0.0, 0.0], positions, 1e-4, smoothing_length=H)
    assert statuses.tolist() == [status]
    np.testing.assert_allclose(matrix.toarray(), average.toarray(), rtol=1e-14)


@pytest.mark.parametrize("slope", [0.0, 0.3, 1e3])
@pytest.mark.parametrize("height", [0.0, 0.003])
@pytest.mark.parametrize("name", ["mls-linear", "mls-quadratic", "sfdi-coupled"])
def test_collinear_neighbours_are_singular(name, slope, height):
    direction = np.array([1.0, slope]) / np.hypot(1.0, slope)
    normal = np.array([-direction[1], direction[0]])
    positions = np.outer(np.linspace(-2.1, 2.3, 9) * 0.01, direction) + height * normal
    matrix, statuses = operator(METHODS[name][0], [0.0, 0.0], positions, 1e-4, smoothing_length=H)
    assert statuses.tolist() == [SINGULAR]
    np.testing.assert_allclose(matrix.sum(), 1.0, rtol=1e-14)


def test_neighbours_on_a_conic_are_singular_for_the_quadratic():
    angles = np.linspace(0.1, 6.0, 9)
    positions = np.column_stack([0.02 * np.cos(angles) + 0.003, 0.012 * np.sin(angles) - 0.002])
    _, statuses = operator(METHODS["mls-quadratic"][0], [0.0, 0.0], positions, 1e-4, smoothing_length=H)
    assert statuses.tolist() == [SINGULAR]


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize(
    ("name", "degree"), [("mls-linear", 1), ("mls-quadratic", 2), ("sfdi-coupled", 1), ("mls-quadratic", 1)]
)
def test_reproduces_polynomials(name, degree, dim):
    positions, volumes, points = lattice(dim)
    matrix, _ = operator(METHODS[name][0], points, positions, volumes, smoothing_length=H)
    powers = [np.ones(dim), np.arange(1.0, dim + 1)][:degree]
    for vector in powers:
        field = (positions @ vector) ** degree
        np.testing.assert_allclose(matrix @ field, (points @ vector) ** degree, rtol=1e-12)


GOOD = {"points": [[0.0, 0.0]], "positions": [[0.0, 0.01]], "volumes": [1e-4], "smoothing_length": H}


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"points": [[0.0, 0.0, 0.0]]}, "points are in 3 dimensions and positions in 2"),
        ({"points": [0.0]}, r"points must have the shape \(n, 2\) or \(n, 3\), got \(1,\)"),
        ({"positions": [[0.0, np.nan]]}, r"positions must be finite, got nan at index \(0, 1\)"),
        ({"positions": "here"}, "positions must be an array of numbers"),
        ({"volumes": [1e-4, 1e-4]}, r"volumes must have the shape \(1,\)"),
        ({"volumes": [-1e-4]}, "volumes must be positive, got .*-0.0001.* for particle 0"),
        ({"smoothing_length": 0.0}, "smoothing_length must be a positive number of metres, got 0.0"),
        ({"lift": [0.0, 0.0]}, "does not extrapolate"),
        ({"kernel": "gausian"}, "gaussian"),
    ],
)
def test_wrong_input_is_explained(changed, message):
    with pytest.raises((InputError, LookupError), match=message):
        operator(METHODS["shepard"][0], **{**GOOD, **changed})
