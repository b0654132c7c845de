from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import BaseModel, ConfigDict, Field

from sphframe import registry
from sphframe.errors import BrokenPluginError, InputError, OutputError
from sphframe.interfaces import Motion, RigidBody


class Body(RigidBody):
    def motion(self, time: float, position: Any, velocity: Any, load: Any) -> Motion:
        return Motion(position, velocity, velocity)


class Plain(Body):
    mass: float = 1.0


@dataclass(frozen=True)
class Spring(Body):
    mass: float
    stiffness: float = 10.0
    name: str = "wall"
    count: int = 1
    locked: bool = False
    form: Literal["free", "fixed"] = "free"
    limit: float | None = None
    centre: tuple[float, float] = (0.0, 0.0)
    share: Annotated[float, Field(ge=0, le=1)] = 0.5
    file: Path | None = None
    series: Sequence[float] = ()
    constant: ClassVar[int] = 3

    def __post_init__(self) -> None:
        if self.mass <= 0:
            raise ValueError("the mass must be positive")
        if self.count == 13:
            raise InputError("count = 13: not that number")
        if self.count == 14:
            raise OutputError("disk full")
        if self.count == 15:
            raise ZeroDivisionError("oops")


class Classic(Body):
    def __init__(self, mass: float = 2.0, **rest: Any) -> None:
        self.mass, self.rest = mass, rest


@dataclass(frozen=True)
class Unresolvable(Body):
    mass: "NoSuchType" = 1.0  # type: ignore[name-defined] # noqa: F821


def make(component: type, /, **options: Any) -> Any:
    return registry.create("rigid_bodies", f"{__name__}:{component.__qualname__}", **options)


def test_options_become_what_their_types_say():
    body = make(
        Spring, mass="2.5", stiffness=3, locked="true", centre=[1, 2], file="a.csv", limit=4, series=[1, 2], count="2"
    )
    assert body == Spring(
        mass=2.5,
        stiffness=3.0,
        locked=True,
        centre=(1.0, 2.0),
        file=Path("a.csv"),
        limit=4.0,
        series=[1.0, 2.0],
        count=2,
    )
    assert type(body.stiffness) is float
    assert make(Spring, mass=np.float32(0.5)).mass == 0.5


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({}, r"needs 'mass'\. Its options: mass, stiffness = 10.0, name = 'wall'"),
        ({"mas": 1}, r"has no option 'mas'; did you mean 'mass'\? Its options: mass, stiffness"),
        ({"mass": 1, "zzz": 1}, r"has no option 'zzz'\. Its options: mass"),
        ({"mass": 1, "constant": 4}, "has no option 'constant'"),
        ({"mass": "heavy"}, "mass = 'heavy': input should be a valid number.*expected float"),
        ({"mass": float("nan")}, "mass = nan: input should be a finite number; expected float"),
        ({"mass": float("inf")}, "mass = inf: input should be a finite number"),
        ({"mass": np.float64("nan")}, "mass = .*nan.*: input should be a finite number"),
        ({"mass": None}, "mass = None: input should be a valid number"),
        ({"mass": True}, "mass = True: input should be a number; expected float"),
        ({"mass": 1, "count": True}, "count = True: input should be a number; expected int"),
        ({"mass": 1, "limit": True}, r"limit = True: input should be a number; expected float \| None"),
        ({"mass": 1, "limit": float("nan")}, "limit = nan: input should be a finite number"),
        ({"mass": 1, "count": 1.5}, "count = 1.5: input should be a valid integer"),
        ({"mass": 1, "form": "loose"}, "form = 'loose': input should be 'free' or 'fixed'"),
        ({"mass": 1, "centre": [1]}, r"centre = \[1\]: field required"),
        ({"mass": 1, "centre": [1, float("nan")]}, "centre = .*finite number"),
        ({"mass": 1, "share": 2}, "share = 2: input should be less than or equal to 1"),
        ({"mass": -1}, "with mass = -1.0: the mass must be positive|Spring': the mass must be positive"),
        ({"mass": 1, "count": 13}, r"with mass = 1.0: count = 13: not that number"),
    ],
)
def test_wrong_options_are_refused_naming_option_value_and_remedy(options: dict[str, Any], message: str):
    with pytest.raises(InputError, match=message) as info:
        make(Spring, **options)
    assert str(info.value).startswith(f"rigid body '{__name__}:Spring'")


def test_errors_that_are_not_about_options_are_told_apart():
    with pytest.raises(OutputError, match="disk full"):
        make(Spring, mass=1, count=14)
    with pytest.raises(BrokenPluginError, match="cannot be made: ZeroDivisionError: oops") as info:
        make(Spring, mass=1, count=15)
    assert isinstance(info.value.__cause__, ZeroDivisionError)


def test_a_plain_class_is_made_by_default_and_says_how_to_have_options():
    assert isinstance(make(Plain), Plain)
    with pytest.raises(InputError, match=r"no option 'mass': write @dataclass\(frozen=True\) above Plain"):
        make(Plain, mass=2.0)
    with pytest.raises(InputError, match=r"no option 'size'\. It takes no options"):
        make(Plain, size=2.0)


def test_the_parameters_of_a_constructor_are_options_too():
    body = make(Classic, mass="3", colour="red")
    assert (body.mass, body.rest) == (3.0, {"colour": "red"})


def test_annotations_that_cannot_be_evaluated_leave_the_judgement_to_the_component():
    assert make(Unresolvable, mass="anything").mass == "anything"


def test_pydantic_components_report_in_the_same_way():
    class Model(BaseModel):
        model_config = ConfigDict(extra="forbid", allow_inf_nan=False)
        depth: float = Field(1.0, gt=0)

    from sphframe.registry.options import construct

    assert construct(Model, "case 'pond'", {"depth": 2}).depth == 2.0
    with pytest.raises(InputError, match="case 'pond': depth: input should be greater than 0"):
        construct(Model, "case 'pond'", {"depth": -1})
    with pytest.raises(InputError, match="case 'pond' has no option 'dept'; did you mean 'depth'"):
        construct(Model, "case 'pond'", {"dept": 1})


@given(st.one_of(st.none(), st.booleans(), st.integers(), st.floats(), st.text(), st.lists(st.integers(), max_size=3)))
def test_any_value_is_a_finite_number_or_an_input_error(value: Any):
    try:
        stiffness = make(Spring, mass=1.0, stiffness=value).stiffness
    except InputError:
        return
    assert type(stiffness) is float
    assert np.isfinite(stiffness)
