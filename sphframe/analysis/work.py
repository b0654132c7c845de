"""Analysis: the work that moving walls do on the fluid."""

import numpy as np
import xarray as xr
from scipy.integrate import cumulative_trapezoid

from sphframe.analysis.placed import moved
from sphframe.arrays import Array
from sphframe.geometry import turning_velocities


def work_of_bodies(dataset: xr.Dataset) -> Array | None:
    """Return the work that bodies have done on the fluid up to each sample (samples,), J, in 2-D per metre of width.

    ::

        W(t) = -int_0^t sum_walls (F . v + M . omega) dt

    with force F and moment M of the fluid on a wall that a body carries, the velocity v of the point to which the
    moment refers, and the angular velocity omega; by the trapezoidal rule over the samples. None without bodies.
    """
    if "body_velocity" not in dataset or "wall_force" not in dataset or not dataset.sizes["probe_time"]:
        return None
    times = dataset["probe_time"].values
    power = np.zeros(len(times))
    for wall, body in enumerate(dataset["wall_body"].values):
        if body >= 0:
            force = dataset["wall_force"].values[:, wall]
            moment = dataset["wall_moment"].values[:, wall].reshape(len(times), -1)
            velocity = dataset["body_velocity"].values[:, body]
            omega = dataset["body_angular_velocity"].values[:, body].reshape(len(times), -1)
            power -= np.einsum("tx,tx->t", force, velocity) + np.einsum("tx,tx->t", moment, omega)
            reference, centre = dataset["wall_reference"].values[wall], dataset["body_centre"].values[body]
            if np.any(reference != centre):
                for k, time in enumerate(times):
                    now, middle = moved(np.vstack([reference, centre]), dataset, int(body), float(time))
                    power[k] -= force[k] @ turning_velocities(omega[k], (now - middle)[None])[0]
    return np.asarray(cumulative_trapezoid(power, times, initial=0.0))
