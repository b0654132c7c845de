"""Simulation: particle shifting and the control of the tensile instability, as a case asks for them."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from sphframe.arrays import Array, BoolArray
from sphframe.cases import Case
from sphframe.compiled import specialise
from sphframe.errors import InputError
from sphframe.interfaces import WallGeometry, WallTreatment
from sphframe.neighbours import NeighbourLists
from sphframe.particles import Columns
from sphframe.physics import LoopParameters
from sphframe.physics.shifting import SURFACE, fluid_fillings, shift_velocities, surface_normals, transported


class Shifting:
    """The loops of :mod:`sphframe.physics.shifting` with the compiled ``parts``; ``coefficient`` S of the shift.

    It keeps no state from one step to the next.
    """

    def __init__(self, parts: Mapping[str, Any], coefficient: float, *, tensile_control: bool) -> None:
        self.coefficient, self.tensile_control = coefficient, tensile_control
        self._fill, self._normals = specialise(fluid_fillings, parts), specialise(surface_normals, parts)
        self._transport = specialise(transported, parts)
        self._found = _scratch(0)

    @classmethod
    def of_case(cls, case: Case, treatment: WallTreatment, parts: Mapping[str, Any]) -> "Shifting | None":
        """Return what ``case`` asks for; None if it asks for neither.

        Raises
        ------
        InputError
            when its walls have no layers of ghosts, without which they look like free surfaces.
        """
        if case.shifting == 0.0 and case.tensile_control == "off":
            return None
        if treatment.geometry is not WallGeometry.LAYERS:
            raise InputError(
                f"shifting and tensile_control need walls with layers of ghosts, which wall_treatment ="
                f" {case.wall_treatment.name!r} has not; leave them out, or choose another one, such as fixed-ghosts"
            )
        return cls(parts, case.shifting, tensile_control=case.tensile_control == "on")

    def find(self, rows: Array, lists: NeighbourLists, parameters: LoopParameters) -> tuple[Array, Array, Array, Array]:
        """Return eigenvalues (n,), sums of kernel gradients, crowding and normals (n, 3) of the fluid particles."""
        if len(self._found[0]) != lists.fluid_count:
            self._found = _scratch(lists.fluid_count)
        eigenvalues, sums, crowding, normals = self._found
        near = lists.fluid, lists.fluid_counts, lists.ghost_counts, lists.shares
        self._fill(rows, *near, parameters, eigenvalues, sums, crowding)
        if np.any(eigenvalues < SURFACE):
            self._normals(rows, lists.fluid, lists.fluid_counts, lists.shares, parameters, eigenvalues, normals)
        else:
            normals[:] = 0.0
        return self._found

    def shift(
        self,
        rows: Array,
        lists: NeighbourLists,
        parameters: LoopParameters,
        speed: float,
        interval: float,
        still: BoolArray | None = None,
    ) -> None:
        """Shift the particles, but those that are ``still`` (n,), after a step of ``interval``, s.

        ``speed``: the largest of the fluid, m/s. Velocities and densities change by their rates half way: an error of
        first order would not change its sign, since particles swing around the places where they are even.
        """
        if self.coefficient > 0.0:
            eigenvalues, _, crowding, normals = self.find(rows, lists, parameters)
            n, columns, h = lists.fluid_count, Columns.of(lists.dim), parameters.smoothing_length
            shifts = self.coefficient * shift_velocities(eigenvalues, crowding, normals, h, speed)
            if still is not None:
                shifts[still] = 0.0
            half, changes = 0.5 * interval * shifts[:, : lists.dim], np.zeros((n, 4))
            near = lists.fluid, lists.fluid_counts, lists.ghost_counts, lists.shares
            rows[:n, columns.position] += half
            self._transport(rows, *near, parameters, shifts, changes)
            rows[:n, columns.position] += half
            rows[:n, columns.velocity] += interval * changes[:, : lists.dim]
            rows[:n, columns.density] += interval * changes[:, 3]

    def control(self, rows: Array, lists: NeighbourLists, parameters: LoopParameters, rates: Array) -> None:
        """Add the control of the tensile instability to the accelerations in ``rates``."""
        if self.tensile_control:
            _, sums, _, normals = self.find(rows, lists, parameters)
            columns, fluid = Columns.of(lists.dim), rows[: lists.fluid_count]
            pressure = np.where(normals.any(axis=1), 0.0, np.minimum(fluid[:, columns.pressure], 0.0))
            rates[:, columns.velocity] += (2.0 * pressure / fluid[:, columns.density])[:, None] * sums[:, : lists.dim]


def _scratch(count: int) -> tuple[Array, Array, Array, Array]:
    return np.zeros(count), np.zeros((count, 3)), np.zeros((count, 3)), np.zeros((count, 3))
