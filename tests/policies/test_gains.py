"""Gains of the controllers: declared once, checked, and set by keyword."""

import numpy as np
import pytest

import policies
from policies.controllers.gains import RENAMED, GainPolicy
from policies.controllers.linear_slip import LinearSlipGains, LinearSlipPolicy
from policies.controllers.sensing import Caution, ConservativePrior
from policies.controllers.table import CLASSES, find, parameters_of

TUNED = [name for name in CLASSES if issubclass(find(name), GainPolicy)]


@pytest.mark.parametrize("name", TUNED)
def test_every_gain_is_documented_with_its_unit_and_a_keyword(name):
    policy = policies.make(name)
    for gain, field in type(policy).Gains.model_fields.items():
        assert "[" in (field.description or ""), gain
        assert gain in parameters_of(type(policy))
        made = policies.make(name, **{gain: field.default})
        assert made.gains == policy.gains


@pytest.mark.parametrize("name", TUNED)
def test_gains_are_frozen(name):
    gains = policies.make(name).gains
    with pytest.raises(ValueError, match="frozen"):
        setattr(gains, next(iter(type(gains).model_fields)), 1.0)


def test_keywords_change_single_gains_of_a_set():
    policy = LinearSlipPolicy(LinearSlipGains(k_x=3.0, k_v=20.0), smoothing=0.9)
    assert policy.gains == LinearSlipGains(k_x=3.0, k_v=20.0, smoothing=0.9)
    with pytest.raises(ValueError, match=r"unknown key 'smothing'; did you mean 'smoothing'"):
        LinearSlipPolicy(smothing=0.9)
    with pytest.raises(ValueError, match=r"k_x = nan: must be a finite number"):
        LinearSlipPolicy(k_x=np.nan)
    with pytest.raises(ValueError, match=r"unknown parameter 'smothing' of policy 'linear_slip'; valid: k_x"):
        policies.make("linear_slip", smothing=0.9)


def test_names_of_version_0_1_0_still_work_and_warn():
    with pytest.warns(DeprecationWarning, match="ConservativePrior"):
        prior = Caution(support=0.3)
    assert prior == ConservativePrior(confidence=0.3)
    with pytest.warns(DeprecationWarning, match="'caution' is now 'prior'"):
        assert policies.make("linear_slip", caution=prior).prior is prior
    with pytest.warns(DeprecationWarning, match="'probe' is now 'exploration'"):
        assert policies.make("hold", probe=None).exploration is None
    with pytest.warns(DeprecationWarning, match="'worth' is now 'least'"):
        assert policies.make("planar_slip", worth=(0.002, 0.04)).gains.least == (0.002, 0.04)
    assert set(RENAMED) == {"caution", "probe", "worth"}
