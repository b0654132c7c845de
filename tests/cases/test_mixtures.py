"""Parts of other dimensions, true and false for numbers, and names that cannot be printed are refused by name."""

from typing import Any

import pytest

from sphframe.cases import load_case
from sphframe.errors import InputError

PLANE_WALL = {"shape": "polygon", "name": "tank", "points": [[0, 1], [0, 0], [1, 0], [1, 1]]}
SOLID_WALL = {"shape": "box", "name": "tank", "lower": [0, 0, 0], "upper": [1, 1, 1], "open_faces": ["+z"]}
PLANE_FLUID = {"shape": "box", "lower": [0, 0], "upper": [1, 0.5]}
SOLID_FLUID = {"shape": "box", "lower": [0, 0, 0], "upper": [1, 1, 0.5]}
NUMBERS = {"particle_spacing": 0.1, "until": 0.1}
PLANE: dict[str, Any] = {**NUMBERS, "walls": [PLANE_WALL], "fluid": [PLANE_FLUID]}
SOLID: dict[str, Any] = {**NUMBERS, "dimension": 3, "walls": [SOLID_WALL], "fluid": [SOLID_FLUID]}
PROBE = {"name": "p", "position": [0, 0]}


@pytest.mark.parametrize(
    ("parameters", "message"),
    [
        ({**SOLID, "walls": [PLANE_WALL]}, "wall 'tank' has 2 coordinates, but dimension = 3 needs 3"),
        ({**SOLID, "fluid": [PLANE_FLUID]}, r"fluid\[0\] has 2 coordinates, but dimension = 3"),
        ({**PLANE, "walls": [SOLID_WALL]}, "wall 'tank' has 3 coordinates, but dimension = 2"),
        ({**PLANE, "fluid": [SOLID_FLUID]}, r"fluid\[0\] has 3 coordinates, but dimension = 2"),
        ({**PLANE, "fluid": [PLANE_FLUID, SOLID_FLUID]}, r"fluid\[1\] has 3 coordinates"),
        ({**SOLID, "walls": [SOLID_WALL, PLANE_WALL]}, "wall 'tank' has 2 coordinates"),
        ({**PLANE, "dimension": 3}, r"fluid\[0\] has 2 coordinates, but dimension = 3"),
        ({**PLANE, "fluid": [{**PLANE_FLUID, "upper": [1, 0.5, 1]}]}, r"fluid\[0\].*do not span a box"),
        ({**PLANE, "fluid": [{**PLANE_FLUID, "upper": [True, 0.5]}]}, r"fluid\[0\]\.upper\[0\] must be a number"),
        ({**PLANE, "probes": [{**PROBE, "position": [False, 0]}]}, r"probes\[0\]\.position\[0\] must be a number"),
        ({**PLANE, "guards": {"fallback_limit": True}}, r"guards\.fallback_limit must be a number"),
        ({**PLANE, "gravity": [0, True]}, r"gravity\[1\] must be a number, not true or false"),
        ({**PLANE, "domain": [[False, -1], [2, 2]]}, r"domain\[0\]\[0\] must be a number"),
        ({**PLANE, "acceleration": [True, 0.0]}, r"vector\[0\] is true or false"),
        ({**PLANE, "probes": [PROBE, {**PROBE, "name": "p\0"}]}, r"'p\\x00', one of the probes, is no name"),
        ({**PLANE, "walls": [{**PLANE_WALL, "name": "\x1b[31m"}]}, r"'\\x1b\[31m', one of the walls, is no name"),
        ({**PLANE, "gauges": [{"name": "a\udcff", "position": [0.5]}]}, r"gauges\[0\]\.name = 'a\\udcff'"),
        ({**PLANE, "bodies": {" ": {"name": "fixed"}}}, "' ', one of the bodies, is no name"),
    ],
)
def test_it_is_refused_by_name(parameters: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        load_case("custom", overrides=parameters)
