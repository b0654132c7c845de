import pytest
from sphframe_mdbc import MDBC

from sphframe import InputError, create
from sphframe.testing import parametrize_with_checks


@parametrize_with_checks([MDBC()])
def test_has_its_traits(method, check):
    check(method)


@pytest.mark.parametrize(("kind", "name"), [("interpolators", "mdbc"), ("wall_treatments", "mdbc-2022")])
def test_an_amplification_below_one_is_refused(kind, name):
    with pytest.raises(InputError, match="amplification must be a number of at least 1"):
        create(kind, name, amplification=0.5)
