"""Cases: what to simulate, as frozen and validated parameters in SI units; built-in, from a TOML file, or in Python."""

from sphframe.cases.case import Case, Guards, Parameter, parameters_of
from sphframe.cases.checks import CaseWarning, check_case
from sphframe.cases.custom import Custom
from sphframe.cases.dam_break_series import WaterColumn
from sphframe.cases.exact import Benchmark, ExactCase
from sphframe.cases.load import load_case, read_toml
from sphframe.cases.open_boundaries import OpenBoundaries, zone_length
from sphframe.cases.parameters import Component, Derived, downward_gravity, quantity, with_default, written
from sphframe.cases.scene import Diagnostic, Gauge, Probe, Scene, Sources, WallPart
from sphframe.interfaces import Fields

__all__ = [
    "Benchmark",
    "Case",
    "CaseWarning",
    "Component",
    "Custom",
    "Derived",
    "Diagnostic",
    "ExactCase",
    "Fields",
    "Gauge",
    "Guards",
    "OpenBoundaries",
    "Parameter",
    "Probe",
    "Scene",
    "Sources",
    "WallPart",
    "WaterColumn",
    "check_case",
    "downward_gravity",
    "load_case",
    "parameters_of",
    "quantity",
    "read_toml",
    "with_default",
    "written",
    "zone_length",
]
