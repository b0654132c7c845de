"""Why one combination does not rest: the eigenvalues of a column of still water.

``python -m validation.hydrostatic_tank.column`` writes the equations of sphframe once more, in plain NumPy and
independently of it, for water that moves only vertically (30 layers of one particle, repeated sideways, over a bed of
fixed ghost particles), lets the column come to rest, linearises it about that state, and prints the growth rate of
the first vertical sound wave.
"""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

LAYERS, GHOSTS, SPACING, LENGTH = 30, 5, 0.01, 0.013  # dx and h, m
SOUND, DENSITY, GRAVITY, CUT = 34.31, 1000.0, 9.81, 3.0  # c0, rho0, g, R/h
SIDEWAYS = np.arange(-5, 6) * SPACING
MIRROR = (np.arange(GHOSTS) + 0.5) * SPACING
NORM = np.pi * LENGTH**2 * (1.0 - 10.0 * np.exp(-9.0))


def kernel(distance: Array) -> Array:
    """Return the renormalised Gaussian."""
    value = (np.exp(-((distance / LENGTH) ** 2)) - np.exp(-9.0)) / NORM
    return np.where(distance < CUT * LENGTH, value, 0.0)


def slope(distance: Array) -> Array:
    """Return -W'(r)/r."""
    value = 2.0 * np.exp(-((distance / LENGTH) ** 2)) / (NORM * LENGTH**2)
    return np.where(distance < CUT * LENGTH, value, 0.0)


def rates(state: Array, method: str, lift: str, diffusion: float, viscosity: float) -> Array:
    """Return the rates of height, velocity and density of all layers."""
    height, velocity, density = state.reshape(3, LAYERS)
    pressure, volume = SOUND**2 * (density - DENSITY), DENSITY_OF_LAYERS * SPACING**2 / density

    offset = height - MIRROR[:, None]
    distance = np.hypot(offset[:, :, None], SIDEWAYS)
    share = kernel(distance) * volume[:, None]
    if method == "shepard-2":  # the weights of improved Shepard: over the square of the distance
        share /= np.maximum(distance, 1e-9) ** 2
    weights = share.sum(axis=2) / share.sum(axis=(1, 2))[:, None]
    centroid = (weights * offset).sum(axis=1)
    rise = 2.0 * MIRROR + (centroid if lift == "balanced" else 0.0)
    answer = MIRROR / (MIRROR + centroid) if lift == "balanced" else 1.0
    ghost_pressure, ghost_velocity = weights @ pressure + DENSITY * GRAVITY * rise, -answer * (weights @ velocity)

    all_height = np.concatenate([height, -MIRROR])
    all_pressure = np.concatenate([pressure, ghost_pressure])
    all_volume = np.concatenate([volume, np.full(GHOSTS, SPACING**2)])
    apart = (all_height - height[:, None])[:, :, None]
    approach = np.concatenate([velocity, ghost_velocity]) - velocity[:, None]
    squared = apart**2 + SIDEWAYS**2
    steep = slope(np.sqrt(squared)) * all_volume[:, None]
    pull = (steep * apart).sum(axis=2)
    nearness = np.divide(steep, squared, out=np.zeros_like(steep), where=squared > 0.0)

    force = -((pressure[:, None] + all_pressure) * pull).sum(axis=1)
    force += viscosity * LENGTH * SOUND * DENSITY * (approach[:, :, None] * nearness * apart**2).sum(axis=(1, 2))
    step, inside = density - density[:, None], slice(0, LAYERS)
    gradient = (step * pull[:, inside]).sum(axis=1) / (steep * apart**2)[:, inside].sum(axis=(1, 2))
    flux = 2.0 * step[:, :, None] - (gradient[:, None] + gradient)[:, :, None] * apart[:, inside]
    density_rate = -density * (approach * pull).sum(axis=1)
    density_rate += diffusion * LENGTH * SOUND * (flux * steep[:, inside]).sum(axis=(1, 2))
    return np.concatenate([velocity, force / density - GRAVITY, density_rate])


START = (np.arange(LAYERS) + 0.5) * SPACING
DENSITY_OF_LAYERS = DENSITY + DENSITY * GRAVITY * (LAYERS * SPACING - START) / SOUND**2


def growth(method: str, lift: str, diffusion: float = 0.1, viscosity: float = 0.02) -> complex:
    """Return the eigenvalue, 1/s, of the first vertical sound wave about the column at rest."""
    state = np.concatenate([START, np.zeros(LAYERS), DENSITY_OF_LAYERS])
    moving, step = slice(LAYERS, 2 * LAYERS), 0.2 * LENGTH / SOUND
    for _ in range(4000):  # damped: 0.3 s
        state[moving] += step * rates(state, method, lift, diffusion, viscosity)[moving]
        state[moving] *= 0.98
        change = rates(state, method, lift, diffusion, viscosity)
        change[moving] = 0.0
        state += step * change
    columns = []
    for k, size in enumerate(np.repeat([1e-7, 1e-4, 1e-3], LAYERS)):
        nudge = np.zeros(3 * LAYERS)
        nudge[k] = size
        up = rates(state + nudge, method, lift, diffusion, viscosity)
        columns.append((up - rates(state - nudge, method, lift, diffusion, viscosity)) / (2.0 * size))
    values = np.linalg.eigvals(np.array(columns).T)
    wave = 1j * SOUND * np.pi / (2.0 * LAYERS * SPACING)
    return complex(values[np.argmin(np.abs(values - wave))])


def main() -> None:
    """Print growth rate and frequency."""
    print("lift      method      delta  alpha  growth, 1/s  frequency, 1/s")
    for method in ("shepard-2", "normalized"):
        for lift in ("balanced", "mirror"):
            for diffusion, viscosity in ((0.1, 0.02), (0.0, 0.02), (0.1, 0.1), (0.0, 0.0)):
                value = growth(method, lift, diffusion, viscosity)
                print(
                    f"{lift:9} {method:11} {diffusion:5.2f}  {viscosity:5.2f}  {value.real:11.2f}  {value.imag:14.1f}",
                    flush=True,
                )


if __name__ == "__main__":
    main()
