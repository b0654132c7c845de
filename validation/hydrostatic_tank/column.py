"""Eigenvalues of a column of still water: why water at rest was unstable with one combination of method and lift.

``python -m validation.hydrostatic_tank.column`` implements the equations of sphframe in plain NumPy, independently of
it, for water that moves only vertically (layers of one particle, repeated sideways, over a bed of fixed ghost
particles). It computes the state of rest of the column, linearises the equations about that state, and prints the
growth rate of the first vertical sound wave, with the ghosts' velocity as the method interpolates it and with the
velocity that is conjugate to their pressure (see :mod:`sphframe.boundary.conjugate`), and the contribution of each part
of the equations at the bed.
"""

from dataclasses import dataclass, replace

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

Array = NDArray[np.float64]

DEPTH, DENSITY, GRAVITY, CUT = 0.3, 1000.0, 9.81, 3.0  # H, rho0, g, R/h
SOUND = 20.0 * float(np.sqrt(GRAVITY * DEPTH))


@dataclass(frozen=True)
class Column:
    """Still water over a bed, and how it is discretised."""

    method: str = "normalized"
    lift: str = "mirror"
    conjugate: bool = True
    """with the mirror lift: whether the ghosts' velocity is conjugate to their pressure, or the method's"""
    diffusion: float = 0.1
    viscosity: float = 0.02
    layers: int = 30
    stretch: float = 1.3
    """h/dx"""

    @property
    def spacing(self) -> float:
        """Return dx, m."""
        return DEPTH / self.layers

    @property
    def length(self) -> float:
        """Return h, m."""
        return self.stretch * self.spacing

    @property
    def mirror(self) -> Array:
        """Return the height of the ghosts' mirror points, m."""
        return (np.arange(np.ceil(CUT * self.stretch - 1e-9), dtype=np.float64) + 0.5) * self.spacing

    @property
    def start(self) -> Array:
        """Return the height of the layers, m."""
        return (np.arange(self.layers, dtype=np.float64) + 0.5) * self.spacing

    @property
    def start_density(self) -> Array:
        """Return the density of the layers at rest, kg/m^3; it fixes their mass, too."""
        density: Array = DENSITY + DENSITY * GRAVITY * (DEPTH - self.start) / SOUND**2
        return density

    def kernel(self, distance: Array) -> Array:
        """Return the renormalised Gaussian, up to its normalisation."""
        value = np.exp(-((distance / self.length) ** 2)) - np.exp(-(CUT**2))
        return np.where(distance < CUT * self.length, value, 0.0)

    def slope(self, distance: Array) -> Array:
        """Return -W'(r)/r."""
        norm = np.pi * self.length**2 * (1.0 - 10.0 * np.exp(-(CUT**2)))
        value = 2.0 * np.exp(-((distance / self.length) ** 2)) / (norm * self.length**2)
        return np.where(distance < CUT * self.length, value, 0.0)

    def sideways(self, vertical: Array) -> Array:
        """Return the distances to a layer's particles that are as far below or above as ``vertical``."""
        distance: Array = np.hypot(vertical[..., None], np.arange(-5, 6) * self.spacing)
        return distance

    def ghosts(self, height: Array, velocity: Array, pressure: Array, volume: Array) -> tuple[Array, Array]:
        """Return velocity and pressure of the ghosts."""
        offset = height - self.mirror[:, None]
        distance = self.sideways(offset)
        share = self.kernel(distance) * volume[:, None]
        if self.method == "shepard-2":  # the weights of improved Shepard: over the square of the distance
            share /= np.maximum(distance, 1e-9) ** 2
        weights = share.sum(axis=2) / share.sum(axis=(1, 2))[:, None]
        centroid = (weights * offset).sum(axis=1)
        rise = 2.0 * self.mirror
        answer = weights.copy()
        if self.lift == "balanced":
            rise += centroid
            answer = (self.mirror / (self.mirror + np.maximum(centroid, -0.5 * self.mirror)))[:, None] * weights
        elif self.conjugate:
            across = height + self.mirror[:, None]
            share = (self.slope(self.sideways(across)).sum(axis=2)) * across * volume
            seen = share.sum(axis=1) > 0.0  # the other ghosts have no particle in their support
            answer[seen] = share[seen] / share[seen].sum(axis=1)[:, None]
        return -(answer @ velocity), weights @ pressure + DENSITY * GRAVITY * rise

    def rates(self, state: Array) -> Array:
        """Return the rates of height, velocity and density of all layers."""
        height, velocity, density = state.reshape(3, self.layers)
        pressure, volume = SOUND**2 * (density - DENSITY), self.start_density * self.spacing**2 / density
        ghost_velocity, ghost_pressure = self.ghosts(height, velocity, pressure, volume)

        all_height = np.concatenate([height, -self.mirror])
        all_pressure = np.concatenate([pressure, ghost_pressure])
        all_volume = np.concatenate([volume, np.full(len(self.mirror), self.spacing**2)])
        apart = all_height - height[:, None]
        approach = np.concatenate([velocity, ghost_velocity]) - velocity[:, None]
        distance = self.sideways(apart)
        steep = self.slope(distance) * all_volume[:, None]
        pull = steep.sum(axis=2) * apart
        near = np.divide(steep, distance**2, out=np.zeros_like(steep), where=distance > 0.0).sum(axis=2)

        force = -((pressure[:, None] + all_pressure) * pull).sum(axis=1)
        force += self.viscosity * self.length * SOUND * DENSITY * (approach * near * apart**2).sum(axis=1)
        step, inside = density - density[:, None], slice(0, self.layers)
        gradient = (step * pull[:, inside]).sum(axis=1) / (pull * apart)[:, inside].sum(axis=1)
        flux = 2.0 * step - (gradient[:, None] + gradient) * apart[:, inside]
        density_rate = -density * (approach * pull).sum(axis=1)
        density_rate += self.diffusion * self.length * SOUND * (flux * steep.sum(axis=2)[:, inside]).sum(axis=1)
        return np.concatenate([velocity, force / density - GRAVITY, density_rate])

    def rest(self) -> Array:
        """Return the state of rest, found by damped motion."""
        state = np.concatenate([self.start, np.zeros(self.layers), self.start_density])
        moving, step = slice(self.layers, 2 * self.layers), 0.2 * self.length / SOUND
        for _ in range(4000):
            state[moving] += step * self.rates(state)[moving]
            state[moving] *= 0.98
            change = self.rates(state)
            change[moving] = 0.0
            state += step * change
        return state

    def jacobian(self, state: Array) -> Array:
        """Return the derivatives of the rates by the state."""
        columns = []
        for k, size in enumerate(np.repeat([1e-7, 1e-4, 1e-3], self.layers)):
            nudge = np.zeros(3 * self.layers)
            nudge[k] = size
            columns.append((self.rates(state + nudge) - self.rates(state - nudge)) / (2.0 * size))
        return np.array(columns).T


def first_wave(jacobian: Array) -> tuple[complex, Array, Array]:
    """Return eigenvalue, 1/s, and left and right eigenvector of the first vertical sound wave."""
    values, left, right = scipy.linalg.eig(jacobian, left=True)
    k = int(np.argmin(np.abs(values - 1j * SOUND * np.pi / (2.0 * DEPTH))))
    return complex(values[k]), left[:, k].conj(), right[:, k]


def growth(column: Column) -> complex:
    """Return growth rate and frequency, 1/s, of the first vertical sound wave about the column at rest."""
    return first_wave(column.jacobian(column.rest()))[0]


def power_beside_the_bed(column: Column) -> Array:
    """Return sum_G V_G sum_j V_j grad_j W_jG (u_j + u_G) dx / V_j, for a unit velocity of each layer alone.

    It is the power, over pressure and velocity, that a bed under uniform pressure gives to the motion of a layer.
    """
    height, volume = column.start, np.full(column.layers, column.spacing**2)
    across = height + column.mirror[:, None]
    pull = column.slope(column.sideways(across)).sum(axis=2) * across * column.spacing**3
    power = []
    for velocity in np.eye(column.layers):
        answer, _ = column.ghosts(height, velocity, np.zeros(column.layers), volume)
        power.append(float((pull * (velocity + answer[:, None])).sum()))
    return np.array(power)


def main() -> None:
    """Print growth rates and the contributions to them."""
    print("lift      ghosts' velocity  method      delta  alpha  growth, 1/s  frequency, 1/s")
    for method in ("shepard-2", "normalized"):
        for lift, conjugate in (("balanced", False), ("mirror", False), ("mirror", True)):
            for diffusion, viscosity in ((0.1, 0.02), (0.0, 0.02), (0.1, 0.1), (0.1, 0.0), (0.0, 0.0)):
                value = growth(Column(method, lift, conjugate, diffusion, viscosity))
                name = "conjugate" if conjugate else "the method's"
                print(
                    f"{lift:9} {name:17} {method:11} {diffusion:5.2f}  {viscosity:5.2f}  {value.real:11.2f}"
                    f"  {value.imag:14.1f}",
                    flush=True,
                )

    print("\nnormalized, mirror lift: growth, 1/s, with the method's velocity and with the conjugate one")
    for layers in (15, 30, 60):
        for stretch in (1.1, 1.2, 1.3, 1.4, 1.5):
            column = Column(layers=layers, stretch=stretch)
            before, after = growth(replace(column, conjugate=False)), growth(column)
            print(f"{layers} layers, h/dx {stretch}: {before.real:6.2f} {after.real:6.2f}", flush=True)

    print("\nnormalized: growth, 1/s, of the operator about the state of rest of another column")
    columns = {"balanced": Column(lift="balanced"), "mirror": Column(conjugate=False), "mirror, conjugate": Column()}
    states = {name: column.rest() for name, column in columns.items()}
    for operator, column in columns.items():
        for about, state in states.items():
            print(
                f"{operator} about the state of rest of {about}: {first_wave(column.jacobian(state))[0].real:.2f}",
                flush=True,
            )

    print("\nfirst-order change of the growth, 1/s, of the mirror lift's wave by a change of the operator alone")
    column, state = columns["mirror"], states["mirror"]
    base = column.jacobian(state)
    _, left, right = first_wave(base)
    for name, changed in (
        ("no diffusion", replace(column, diffusion=0.0)),
        ("no viscosity", replace(column, viscosity=0.0)),
        ("ghosts' velocity conjugate", columns["mirror, conjugate"]),
        ("balanced lift", columns["balanced"]),
    ):
        change = left @ (changed.jacobian(state) - base) @ right / (left @ right)
        print(f"{name:27} {change.real:6.2f}")

    print("\npower of the bed on a motion of the first layers, one by one, over pressure and velocity")
    for method in ("shepard-2", "normalized"):
        for conjugate in (False, True):
            power = power_beside_the_bed(Column(method, conjugate=conjugate))[:4]
            print(f"{method:11} {'conjugate' if conjugate else 'the method`s':13}", np.round(power, 3) + 0.0)


if __name__ == "__main__":
    main()
