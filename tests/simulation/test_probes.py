"""Sensors: points and discs."""

import numpy as np
import pytest

from sphframe.cases import Probe
from sphframe.simulation.probes import PressureProbes

DISC = Probe(name="disc", position=(0.0, 1.0), radius=0.2, tangent=(0.0, 1.0))


def test_a_disc_averages_over_its_area():
    probes = PressureProbes([DISC, Probe(name="point", position=(0.5, 0.5))], 2)
    height = probes.points[:, 1]
    average = probes.average(100.0 + 3.0 * height**2)
    # the mean of z^2 over a disc of radius a centred at z0 is z0^2 + a^2/4
    assert average[0] == pytest.approx(100.0 + 3.0 * (1.0 + 0.2**2 / 4.0), rel=1e-3)
    assert average[1] == pytest.approx(100.75)


def test_negative_pressures_are_clipped_to_zero_at_a_disc_and_not_at_a_point():
    probes = PressureProbes([DISC, Probe(name="point", position=(0.5, 0.5))], 2)
    assert list(probes.average(np.full(len(probes.points), -5.0))) == [0.0, -5.0]
