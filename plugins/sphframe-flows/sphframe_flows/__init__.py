"""Flows with exact answers for sphframe, and the bodies and body forces that drive them."""

from sphframe_flows.accelerated_tank import AcceleratedTank
from sphframe_flows.channels import Couette, Poiseuille
from sphframe_flows.cylinder_array import CylinderArray
from sphframe_flows.cylinder_in_channel import CylinderInChannel
from sphframe_flows.dam_break_3d import DamBreak3D
from sphframe_flows.dam_break_impact import DamBreakImpact
from sphframe_flows.drum import Drum
from sphframe_flows.forces import Roll, RotatingFrame, Surge
from sphframe_flows.hydrostatic_wedge import HydrostaticWedge
from sphframe_flows.impacts import CeilingRelease, ColumnImpact
from sphframe_flows.jet_on_plate import JetOnPlate
from sphframe_flows.lid_driven_cavity import LidDrivenCavity
from sphframe_flows.manufactured import ManufacturedFlow
from sphframe_flows.moving_square import MovingSquare
from sphframe_flows.oblique_jet import ObliqueJet
from sphframe_flows.oscillating import Oscillating
from sphframe_flows.oscillating_cylinder import OscillatingCylinder
from sphframe_flows.rotating_bucket import RotatingBucket
from sphframe_flows.sloshing_tank import SloshingTank
from sphframe_flows.smooth_start import SmoothStart
from sphframe_flows.spinning import Spinning
from sphframe_flows.standing_wave import StandingWave
from sphframe_flows.still_water import CircularSill, SubmergedBox, TiltedTank, TwoBasins
from sphframe_flows.stokes_plate import StokesPlate
from sphframe_flows.taylor_couette import TaylorCouette
from sphframe_flows.taylor_green import TaylorGreen

__all__ = [
    "AcceleratedTank",
    "CeilingRelease",
    "CircularSill",
    "ColumnImpact",
    "Couette",
    "CylinderArray",
    "CylinderInChannel",
    "DamBreak3D",
    "DamBreakImpact",
    "Drum",
    "HydrostaticWedge",
    "JetOnPlate",
    "LidDrivenCavity",
    "ManufacturedFlow",
    "MovingSquare",
    "ObliqueJet",
    "Oscillating",
    "OscillatingCylinder",
    "Poiseuille",
    "Roll",
    "RotatingBucket",
    "RotatingFrame",
    "SloshingTank",
    "SmoothStart",
    "Spinning",
    "StandingWave",
    "StokesPlate",
    "SubmergedBox",
    "Surge",
    "TaylorCouette",
    "TaylorGreen",
    "TiltedTank",
    "TwoBasins",
]
