"""A linear fit in those directions alone in which the neighbours are spread: the fallback ``rank-revealing``."""

import math

from sphframe import OK, CompiledKernel, WeightsFunction, local_array

_NO_SPREAD, _SPREAD = 0.1, 0.2
"""standard deviations of the neighbours, in h, up to which a direction is left out, and from which it is complete"""
_SWEEPS = {2: 1, 3: 6}
"""sweeps of Jacobi rotations, by dimension: one rotation is exact in 2-D, and six sweeps leave round-off in 3-D"""


def rank_revealing(average: WeightsFunction, kernel: CompiledKernel, dim: int, amplification: float) -> WeightsFunction:
    """Return weights that are linear along the directions in which the neighbours are spread, constant across them.

    With a_j = W_j V_j / sum_k W_k V_k, the mean offset c = sum_j a_j x_j and the covariance
    C = sum_j a_j (x_j - c)(x_j - c)^T, of eigenvalues s_k^2 and eigenvectors q_k::

        Phi_j = a_j - t a_j (x_j - c) . G c,   G = sum_k f(s_k / h) / s_k^2 q_k q_k^T

    f is 0 up to a standard deviation s_k of 0.1 h and 1 from 0.2 h, with a smooth step in s_k^2 between. Where every f
    is 0 or 1 and t = 1, this is the weighted linear fit in the space of the directions with f = 1. The step is at a
    share of h, not of the largest s_k: so the weights do not jump where a particle enters the support, where the rank
    changes or where eigenvalues are equal. t = min(1, (A - 1) / (sum_j |Phi_j(t = 1)| - 1)) bounds sum_j |Phi_j| by the
    amplification A, without a jump for A > 1.

    Parameters
    ----------
    average
        the function of the weights a_j.
    kernel
        whose support gives h.
    dim
        2 or 3.
    amplification
        the largest sum of absolute weights.
    """
    entries, sweeps, smoothing_lengths = dim * dim, _SWEEPS[dim], kernel.support
    low, high = _NO_SPREAD**2, _SPREAD**2

    def rotate(array, one, other, stride, cosine, sine):  # type: ignore[no-untyped-def]
        for _ in range(dim):
            first, second = array[one], array[other]
            array[one], array[other] = cosine * first - sine * second, sine * first + cosine * second
            one += stride
            other += stride

    def rise(offsets, j, per_length, mean, slope):  # type: ignore[no-untyped-def]
        total = 0.0
        for a in range(dim):
            total += (offsets[j, a] * per_length - mean[a]) * slope[a]
        return total

    def weights(offsets, distances, kernel_values, volumes, support, lift, out):  # type: ignore[no-untyped-def]
        n = distances.shape[0]
        average(offsets, distances, kernel_values, volumes, support, lift, out)
        per_length = smoothing_lengths / support
        mean, slope = local_array(dim), local_array(dim)
        matrix, vectors = local_array(entries), local_array(entries)  # the covariance; its eigenvectors in columns
        for a in range(dim):
            mean[a] = slope[a] = 0.0
            for j in range(n):
                mean[a] += out[j] * offsets[j, a] * per_length
            for b in range(a + 1):
                total = 0.0
                for j in range(n):
                    total += out[j] * (offsets[j, a] * per_length - mean[a]) * (offsets[j, b] * per_length - mean[b])
                matrix[a * dim + b] = matrix[b * dim + a] = total
                vectors[a * dim + b] = vectors[b * dim + a] = 1.0 if a == b else 0.0

        for _ in range(sweeps):
            for p in range(dim - 1):
                for q in range(p + 1, dim):
                    if matrix[p * dim + q] != 0.0:
                        ratio = 0.5 * (matrix[q * dim + q] - matrix[p * dim + p]) / matrix[p * dim + q]
                        tangent = math.copysign(1.0, ratio) / (abs(ratio) + math.sqrt(1.0 + ratio * ratio))
                        cosine = 1.0 / math.sqrt(1.0 + tangent * tangent)
                        rotate(matrix, p, q, dim, cosine, tangent * cosine)
                        rotate(matrix, p * dim, q * dim, 1, cosine, tangent * cosine)
                        rotate(vectors, p, q, dim, cosine, tangent * cosine)

        for k in range(dim):  # slope = G c
            variance = matrix[k * dim + k]
            step = min(max((variance - low) / (high - low), 0.0), 1.0)
            if step > 0.0:
                along = 0.0
                for a in range(dim):
                    along += vectors[a * dim + k] * mean[a]
                for a in range(dim):
                    slope[a] += step * step * (3.0 - 2.0 * step) / variance * along * vectors[a * dim + k]

        size = 0.0
        for j in range(n):
            size += abs(out[j] * (1.0 - rise(offsets, j, per_length, mean, slope)))
        share = 1.0 if size <= amplification else (amplification - 1.0) / (size - 1.0)
        for j in range(n):
            out[j] *= 1.0 - share * rise(offsets, j, per_length, mean, slope)
        return OK

    return weights
