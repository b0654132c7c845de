import pytest
from sphframe_sfdi import SFDI

from sphframe.testing import parametrize_with_checks


@parametrize_with_checks([SFDI()])
def test_has_its_traits(method, check):
    check(method)


@pytest.mark.long
@parametrize_with_checks([SFDI(form="printed")])
def test_the_printed_form_has_its_traits(method, check):
    check(method)
