"""Names of the form module:attribute."""

import pickle

import pytest

import estimator
import policies
from estimator.registry import specification
from slipgym.tasks import find


@pytest.mark.parametrize("make", [estimator.make, policies.make, find])
@pytest.mark.parametrize("name", ["no_such_module:THING", "math:THING", "math:pi", "math:sqrt"])
def test_what_is_not_there_or_of_another_kind_is_refused(make, name):
    with pytest.raises(ValueError, match=name):
        make(name)


def test_only_a_class_with_predict_is_a_policy():
    with pytest.raises(ValueError, match="a class with a method predict"):
        policies.make("subprocess:Popen", args=["true"])
    assert policies.find("policies.controllers.hold:HoldPolicy") is policies.find("hold")


def test_a_specification_has_the_name_it_is_asked_by():
    with pytest.raises(ValueError, match="no Specification of this name"):
        estimator.make("estimator.rls:SPECIFICATION")
    assert pickle.loads(pickle.dumps(specification("rls"))) is specification("rls")
