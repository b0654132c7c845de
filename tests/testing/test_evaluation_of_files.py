"""``sphframe evaluate``: particles in the layouts of four programs, and methods judged on them."""

import json

import h5py
import numpy as np
import pytest
import pyvista

from sphframe import OK, InputError, create, run
from sphframe.cli.evaluate import evaluate_command
from sphframe.interfaces import Status
from sphframe.testing.judgement import judge, judge_walls
from sphframe.testing.particle_files import Particles, WallPoints, read_particles, read_walls

SPACING = 0.01
X, Y = (a.ravel() for a in np.meshgrid((np.arange(20) + 0.5) * SPACING, (np.arange(15) + 0.5) * SPACING, indexing="ij"))
PRESSURE = 9810.0 * (0.15 - Y) + 100.0 * X
DENSITY = 1000.0 + PRESSURE / 400.0


def vtk(path, points, **fields):
    mesh = pyvista.PolyData(points)
    if path.suffix == ".vtu":
        mesh = mesh.cast_to_unstructured_grid()
    for name, values in fields.items():
        mesh.point_data[name] = values
    mesh.save(path)
    return path


@pytest.fixture
def files(tmp_path):
    """A pool in the layout of each program."""
    zero = np.zeros_like(X)
    velocity = np.stack([zero, zero, zero], axis=1)
    found = {
        "DualSPHysics": vtk(
            tmp_path / "PartFluid_0001.vtk", np.stack([X, zero, Y], axis=1).astype(np.float32),
            Idp=np.arange(len(X)), Vel=velocity, Rhop=DENSITY.astype(np.float32), Press=PRESSURE.astype(np.float32),
        ),
        "TrixiParticles": vtk(
            tmp_path / "fluid_1_10.vtu", np.stack([X, Y, zero], axis=1), index=np.arange(len(X)), velocity=velocity,
            density=DENSITY, pressure=PRESSURE, particle_spacing=np.full(len(X), SPACING),
        ),
        "PySPH": tmp_path / "pool_100.hdf5",
    }  # fmt: skip
    with h5py.File(found["PySPH"], "w") as file:
        file.create_group("solver_data").attrs["t"] = 0.1
        for name in ("fluid", "wall"):
            group = file.create_group(f"particles/{name}/arrays")
            stored = {"x": X, "y": Y, "z": zero, "rho": DENSITY, "p": PRESSURE, "m": 1.1e-4 * DENSITY}
            for key, values in stored.items():
                group.create_dataset(key, data=values).attrs["stored"] = True
            group.create_dataset("h", data=np.full(len(X), 0.0125)).attrs["stored"] = True
            group.create_dataset("au", (0,), dtype="f4").attrs["stored"] = False
    return found


@pytest.mark.parametrize("program", ["DualSPHysics", "TrixiParticles", "PySPH"])
def test_particles_of_other_programs_are_read(files, program):
    particles = read_particles(files[program])
    assert np.allclose(particles.position, np.stack([X, Y], axis=1), atol=1e-7)
    assert np.allclose(particles.pressure, PRESSURE, rtol=1e-6)
    assert particles.spacing == pytest.approx(SPACING, rel=1e-5)
    assert particles.smoothing_length == (0.0125 if program == "PySPH" else None)
    assert np.allclose(particles.volume, 1.1e-4 if program == "PySPH" else 1e-4, rtol=1e-4)


def test_names_can_be_given_and_mistakes_are_explained(files, tmp_path):
    path = vtk(tmp_path / "other.vtu", np.stack([X, Y, 0 * X], axis=1), druck=PRESSURE)
    with pytest.raises(InputError, match="no pressure of particles; it has druck: name the field, such as --field"):
        read_particles(path)
    assert np.array_equal(read_particles(path, fields={"pressure": "druck"}).pressure, PRESSURE)
    for arguments, complaint in (
        ({"path": path, "fields": {"pressure": "p"}}, "has no field 'p'; it has druck"),
        ({"path": path, "fields": {"druck": "p"}}, "fields druck are unknown: choose pressure, density"),
        ({"path": tmp_path / "none.vtk"}, "none.vtk does not exist"),
        ({"path": tmp_path / "run.csv"}, "expected a file that ends in"),
        ({"path": files["PySPH"], "array": "solid"}, "holds the particle arrays fluid, wall: choose one by --array"),
    ):
        with pytest.raises(InputError, match=complaint):
            read_particles(**arguments)
    (tmp_path / "damaged.hdf5").write_bytes(b"no HDF5")
    with pytest.raises(InputError, match="cannot read particles from"):
        read_particles(tmp_path / "damaged.hdf5")


def test_linear_methods_reproduce_the_pressure_of_each_particle_from_the_others():
    rng = np.random.default_rng(1)
    position = np.stack([X, Y], axis=1) + rng.uniform(-0.1, 0.1, (len(X), 2)) * SPACING
    pressure = 1000.0 + position @ [100.0, -9810.0]
    particles = Particles(position, np.full(len(X), SPACING**2), pressure, SPACING)
    exact = judge(create("interpolators", "mls-linear"), particles)
    assert np.abs(exact.error[exact.status == OK]).max() < 1e-8
    mean = judge(create("interpolators", "normalized"), particles)
    assert exact.distance() < 1e-3 < mean.distance(~mean.inside)
    assert 3 * mean.distance(mean.inside) < mean.distance(~mean.inside)
    assert mean.inside.sum() > 0.3 * len(X)
    assert np.allclose(mean.gain, 1.0)
    assert mean.share(Status.OK) == 1.0
    assert np.median(mean.noise) == pytest.approx(0.31, abs=0.05)  # weights of about ten neighbours


def water_above_a_bed():
    """Particles of still water with a jitter, and three layers of ghosts below it that hold its pressure."""
    rng = np.random.default_rng(2)
    position = np.stack([X, Y], axis=1) + rng.uniform(-0.1, 0.1, (len(X), 2)) * SPACING
    x, depth = np.meshgrid((np.arange(5, 15) + 0.5) * SPACING, np.array([0.5, 1.5, 2.5]) * SPACING)
    ghost, mirror = (np.column_stack([x.ravel(), sign * depth.ravel()]) for sign in (-1.0, 1.0))
    force = np.array([0.0, -9810.0])
    particles = Particles(position, np.full(len(X), SPACING**2), 1000.0 + position @ force, SPACING)
    return particles, WallPoints(ghost, mirror, 1000.0 + ghost @ force, force)


@pytest.mark.parametrize("name", ["normalized", "mls-linear", "mdbc", "adami"])
def test_pressure_at_walls_is_that_of_still_water(name):
    particles, walls = water_above_a_bed()
    found = judge_walls(create("interpolators", name), particles, walls)
    assert found.share(Status.OK) == 1.0
    assert np.abs(found.error).max() < 1e-8 * found.scale  # the sum of the weights is one: the lift does the rest


def test_errors_at_walls_are_interpolated_less_stored_pressures():
    particles, walls = water_above_a_bed()
    weightless = WallPoints(walls.position, walls.mirror, walls.pressure + 50.0, np.zeros(2))
    found = judge_walls(create("interpolators", "mls-linear"), particles, weightless)
    np.testing.assert_allclose(found.error, (walls.mirror - walls.position) @ walls.force - 50.0, atol=1e-8)


def test_wall_particles_of_other_programs_are_read(files, tmp_path):
    particles = read_particles(files["DualSPHysics"])
    low = np.stack([X[:20], 0 * X[:20], -0.5 * SPACING + 0 * X[:20]], axis=1)
    up = np.tile([0.0, 0.0, 0.5 * SPACING], (20, 1))
    path = vtk(tmp_path / "PartBound_0001.vtk", low, Press=np.full(20, 1500.0), BoundNor=up)
    walls = read_walls(files["DualSPHysics"], particles, walls=str(path), gravity=9.81, fields={"normal": "BoundNor"})
    assert np.allclose(walls.position, low[:, [0, 2]])
    assert np.allclose(walls.mirror, low[:, [0, 2]] * [1.0, -1.0])
    assert np.allclose(walls.force, [0.0, -9.81 * np.median(DENSITY)], rtol=1e-6)
    assert np.array_equal(walls.pressure, np.full(20, 1500.0))
    assert np.array_equal(read_walls(files["DualSPHysics"], particles, walls=str(path)).mirror, walls.position)
    assert read_walls(files["DualSPHysics"], particles) is None
    of_pysph = read_walls(files["PySPH"], read_particles(files["PySPH"]), walls="wall")
    assert np.allclose(of_pysph.pressure, PRESSURE)
    with pytest.raises(InputError, match=r"x\.vtk does not exist"):
        read_walls(files["DualSPHysics"], particles, walls="x.vtk")
    bare = vtk(tmp_path / "bare.vtk", low, mass=np.ones(20))
    with pytest.raises(InputError, match="has no pressure of wall particles; it has"):
        read_walls(files["DualSPHysics"], particles, walls=str(bare))


def test_lonely_particles_are_dry():
    particles = Particles(np.array([[0.0, 0.0], [1.0, 0.3]]), np.ones(2), np.ones(2), 0.01)
    assert judge(create("interpolators", "normalized"), particles).share(Status.DRY) == 1.0


def test_the_command_judges_a_run_and_other_files(files, tmp_path, capsys):
    tank = {"particle_spacing": 0.03, "until": 0.002, "frame_interval": 0.001}
    run("hydrostatic-tank", output=tmp_path / "tank.nc", threads=1, **tank)
    for path in (tmp_path / "tank.nc", files["DualSPHysics"]):
        evaluate_command(
            path, ["normalized"], kernel="gaussian", smoothing_length=None, as_json=True, reading={}, sample=100
        )
        (figures,) = json.loads(capsys.readouterr().out).values()
        assert figures["error_inside"] < 0.05
        assert figures["statuses"]["OK"] == 1.0
        assert ("walls" in figures) == (path.suffix == ".nc")
        if "walls" in figures:  # of a method that the run did not use
            assert figures["walls"]["error"] < 0.1
            assert figures["walls"]["wall_particles"] == 100
    evaluate_command(
        files["PySPH"], ["normalized"], kernel="gaussian", smoothing_length=None, as_json=False, reading={}, sample=100
    )
    shown = capsys.readouterr().out
    assert "300 particles in 2-D, spacing 0.01 m, h = 0.0125 m, gaussian" in shown
    assert "normalized" in shown
    assert "OK 100.00 %" in shown
    assert "wall particles" not in shown
    evaluate_command(
        files["PySPH"], ["normalized"], kernel="gaussian", smoothing_length=None, as_json=False, reading={}, sample=100,
        walls="wall",
    )  # fmt: skip
    assert "100 wall particles" in capsys.readouterr().out
