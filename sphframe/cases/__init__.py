"""Cases: what to simulate, as frozen and validated parameters in SI units; built-in, from a TOML file, or in Python."""

from sphframe.cases.case import (
    Case,
    Component,
    Derived,
    Diagnostic,
    Fields,
    Gauge,
    Guards,
    Parameter,
    Probe,
    Scene,
    parameters_of,
    quantity,
    written,
)
from sphframe.cases.checks import CaseWarning, check_case
from sphframe.cases.custom import Custom
from sphframe.cases.load import load_case, read_toml

__all__ = [
    "Case",
    "CaseWarning",
    "Component",
    "Custom",
    "Derived",
    "Diagnostic",
    "Fields",
    "Gauge",
    "Guards",
    "Parameter",
    "Probe",
    "Scene",
    "check_case",
    "load_case",
    "parameters_of",
    "quantity",
    "read_toml",
    "written",
]
