"""Wave flumes for sphframe: solitary waves on seawalls, and the paddles that make waves."""

from sphframe_waves.fixed_wall import SolitaryWaveFixedWall
from sphframe_waves.flume import SolitaryWaveFlume
from sphframe_waves.movable_wall import SolitaryWaveMovableWall
from sphframe_waves.regular_wave_paddle import RegularWavePaddle
from sphframe_waves.solitary_wave_paddle import SolitaryWavePaddle

__all__ = [
    "RegularWavePaddle",
    "SolitaryWaveFixedWall",
    "SolitaryWaveFlume",
    "SolitaryWaveMovableWall",
    "SolitaryWavePaddle",
]
