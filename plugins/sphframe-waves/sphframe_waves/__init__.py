"""Wave flumes for sphframe: solitary waves on seawalls and past a column, and the paddles that make waves."""

from sphframe_waves.column import SolitaryWaveColumn
from sphframe_waves.column_diffraction import ColumnDiffraction
from sphframe_waves.fixed_wall import SolitaryWaveFixedWall
from sphframe_waves.flume import SolitaryWaveFlume
from sphframe_waves.movable_wall import SolitaryWaveMovableWall
from sphframe_waves.regular_wave_paddle import RegularWavePaddle
from sphframe_waves.solitary_wave_paddle import SolitaryWavePaddle

__all__ = [
    "ColumnDiffraction",
    "RegularWavePaddle",
    "SolitaryWaveColumn",
    "SolitaryWaveFixedWall",
    "SolitaryWaveFlume",
    "SolitaryWaveMovableWall",
    "SolitaryWavePaddle",
]
