"""A stand-in for a simulation: every quantity is a known function of time.

Run as a program, it starts a process for each line ``DELAY FILE`` of its input, which writes that file and is killed
after DELAY s of processor time.
"""

import os
import signal
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import Any, ClassVar

import numpy as np

from sphframe.cases import Case, Diagnostic, Fields, Gauge, Probe, Scene
from sphframe.geometry import BoxRegion, PolygonWall
from sphframe.interfaces import Motion, RigidBody, Status, WallLoad
from sphframe.output import NetCDFWriter


class Paddle(RigidBody):
    def motion(self, time: float, position: Any, velocity: Any, load: Any) -> Motion:
        return Motion(np.array([time, 0.0, 0.0]), np.array([1.0, 0.0, 0.0]), np.zeros(3))


class FakeCase(Case):
    title: ClassVar[str] = "A case for tests"
    particle_spacing: float = 0.1
    until: float = 1.0
    frame_interval: float = 0.1
    probe_interval: float = 0.01
    probe_count: int = 2

    def scene(self) -> Scene:
        names = ["left", "Gefäß"][: self.probe_count]
        return Scene(
            walls=(
                PolygonWall(name="tank", points=((0, 1), (0, 0), (1, 0))),
                PolygonWall(name="paddle", points=((1, 0), (1, 1)), body="paddle"),
            ),
            fluid=(BoxRegion(lower=(0, 0), upper=(1, 0.5)),),
            depth=0.5,
            domain=((0.0, 0.0), (2.0, 2.0)),
            probes=tuple(Probe(name=name, position=(0.0, 0.1 * k)) for k, name in enumerate(names)),
            gauges=(Gauge(name="middle", position=(0.5,)),),
            bodies={"paddle": Paddle()},
            diagnostics=(Diagnostic("front_position", "m", "position of the front", lambda fields: 2.0),),
        )


class FakeSimulation:
    """The part of sphframe.interfaces.RunView that the writer uses."""

    def __init__(self, case: Any = None, particles: int = 50) -> None:
        self.case = case or FakeCase()
        self.scene = self.case.scene()
        self.time, self.step, self.time_step, self.wall_clock = 0.0, 0, 0.01, 0.0
        self.processor_time = 0.0
        self.sound_speed, self.smoothing_length = 44.3, 0.13
        self.fluid_count, self.ghost_count = particles, 20
        self.particle_count = particles
        self.removed_count = self.densities_outside = 0
        self.ghosts = SimpleNamespace(
            position=np.full((20, 2), -0.1), mirror=np.full((20, 2), 0.1), body=np.full(20, -1)
        )

    def fields(self) -> Fields:
        n = self.fluid_count
        position = np.stack([np.arange(n) + self.time, np.zeros(n)], axis=1)
        return Fields(position, np.ones((n, 2)), np.full(n, 1000.0 + self.time), np.full(n, self.time))

    def masses(self) -> Any:
        return np.full(self.fluid_count, 10.0)

    def ghost_fields(self) -> Fields:
        return Fields(self.ghosts.position, np.zeros((20, 2)), np.full(20, 1e3), np.full(20, 7.0))

    def probe_pressures(self) -> Any:
        return 100.0 * self.time + np.arange(len(self.scene.probes))

    def probe_readings(self) -> Any:
        return self.probe_pressures(), np.ones(len(self.scene.probes), np.bool_)

    def gauge_readings(self) -> Any:
        return np.array([0.5]), np.array([0.4])

    def energies(self) -> dict[str, float]:
        return {"kinetic": self.time, "potential": 2.0, "internal": 1.0}

    def diagnostics(self) -> dict[str, float]:
        return {"front_position": 2.0 + self.time}

    def status_counts(self) -> Any:
        counts = np.zeros(len(Status), dtype=np.int64)
        counts[0] = self.ghost_count
        return counts

    def body_motions(self) -> dict[str, Motion]:
        return {"paddle": self.scene.bodies["paddle"].motion(self.time, None, None, None)}

    def wall_loads(self) -> dict[str, Any]:
        load = WallLoad(np.array([1.0, 2.0]), np.array([1.5, 2.5]), np.array([3.0]), np.array([3.5]))
        return {wall.name: load for wall in self.scene.walls}

    def particles_outside(self) -> int:
        return 0

    def advance(self) -> None:
        self.step += 1
        self.time = self.step * self.time_step


def play(writer: NetCDFWriter, simulation: FakeSimulation, steps: int) -> None:
    """Frames at every tenth step, samples at every step, as the run loop does; neither start nor end."""
    for _ in range(steps):
        writer.sphframe_probes_due(simulation=simulation)
        if simulation.step % 10 == 0:
            writer.sphframe_frame_due(simulation=simulation)
        simulation.advance()


def write_run(path: Path) -> Path:
    """Write the file of a run of 31 samples and four frames from start to end, and return its name."""
    writer, simulation = NetCDFWriter(path), FakeSimulation()
    writer.sphframe_run_started(simulation=simulation)
    play(writer, simulation, 31)
    writer.sphframe_run_finished(simulation=simulation)
    return path


if __name__ == "__main__":
    for line in sys.stdin:
        delay, path = line.strip().split(" ", 1)
        child = os.fork()
        if child == 0:
            try:
                endless = FakeSimulation(FakeCase(until=100.0), particles=2000)
                endless_writer = NetCDFWriter(path, flush_interval=0.005)
                endless_writer.sphframe_run_started(simulation=endless)
                signal.signal(signal.SIGPROF, signal.SIG_DFL)
                signal.setitimer(signal.ITIMER_PROF, float(delay))  # of processor time, however busy the machine is
                play(endless_writer, endless, 9_000)
            finally:
                os._exit(1)
        _, status = os.waitpid(child, 0)
        print("killed" if os.WIFSIGNALED(status) else "ended", flush=True)
