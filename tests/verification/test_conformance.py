"""What every restitution model promises, tried on every registered one over random asymmetric bodies.

A new model is picked up by its registration, with the parameters that its class has for trials. Where its class says
that it breaks an identity, the breach itself is asserted: it
is the negative control.
"""

import math
from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from random_cases import sections

import rocking as rk
from rocking.conventions import opposite
from rocking.restitution import Fixed, Flag, Housner, Interface, Ked, Restitution, RestitutionModel
from rocking.restitution.space import spatial_models

pytestmark = pytest.mark.verifies("invariant", room="restitution in the plane")

MODELS = [
    rk.restitution.model(f"{name}:{parameters}")
    for name, kind in rk.restitution.models().items()
    for parameters in kind.trials
] + [rk.restitution.model("0.9*ked")]
AT_ONE = [Interface(Housner(), 1.0), Interface(Fixed(1.0), 1.0), Interface(Ked(), 1.0), Fixed(1.0)]
KINDS = {**rk.restitution.models(), **spatial_models()}
every_model = pytest.mark.parametrize("model", MODELS, ids=[model.label for model in MODELS])
few = settings(max_examples=12, suppress_health_check=[HealthCheck.too_slow, HealthCheck.filter_too_much])


@dataclass(frozen=True)
class Broken(RestitutionModel):
    """A model that breaks one promise at a time."""

    how: str
    name = "broken"
    inertia_only = True

    def raw_coefficient(self, body, foot):  # noqa: PLR0911
        new, old = body.side(foot), body.side(opposite(foot))
        if self.how == "size":
            return 1.0 / (1.0 + 0.1 * new.half_width)
        if self.how == "density":
            return 1.0 / (1.0 + 1e-6 * new.mass / new.semi_diagonal**2)
        if self.how == "mirror":
            return 0.9 if foot == "right" else 0.8
        if self.how == "place":
            return 1.0 / (2.0 + math.sin(body.feet[0]))
        if self.how == "inertia":
            return 0.5 + 0.1 * body.local_moments.yy / body.local_moments.polar
        if self.how == "slenderness":
            return 1.0 / new.slenderness_ratio
        return 1.001 * math.sqrt(old.moment_of_inertia / new.moment_of_inertia)

    def raw_of_slenderness(self, slenderness):
        return 0.5 / slenderness


def same(model, body, other, foot="right", other_onto=None):
    here, there = model.coefficient(body, foot), model.coefficient(other, other_onto or foot)
    return math.isclose(here, there, rel_tol=1e-8, abs_tol=1e-11)


def elsewhere(body, dx, up):
    """The same body built far away; the offsets are multiples of 1/8 that floats near 1e3 hold to 1e-13."""
    (region,) = body.regions
    ring = np.add(region.outline, (body.origin_x + dx, up))
    return rk.Section.from_points(ring, region.density, feet=tuple(x + dx for x in body.feet), ground=up)


def bounded(model, body, foot):
    new, old = body.side(foot), body.side(opposite(foot))
    r = model.coefficient(body, foot)
    return r * r * new.moment_of_inertia <= old.moment_of_inertia * (1.0 + 1e-12)


@pytest.mark.slow
@pytest.mark.verifies(
    against="the same body of another size, density and side, and a kilometre away",
    within="1e-8",
    control="test_invariance_criterion_rejects_broken_models",
)
@every_model
@few
@given(body=sections())
def test_scale_density_mirror_place(model, body):
    """The coefficient does not see size, density, mirror or position."""
    for foot in ("left", "right"):
        assert same(model, body, body.scaled(size=7.3), foot)
        assert same(model, body, body.scaled(density=0.013), foot)
        assert same(model, body, body.mirrored(), foot, opposite(foot))
        assert same(model, body, elsewhere(body, 1000.125, -17.5), foot)


@pytest.mark.verifies("negative control", "models that see metres, kilograms, sides or the origin")
@few
@given(body=sections())
def test_invariance_criterion_rejects_broken_models(body):
    """Negative control: models that see metres, kilograms, left and right, or the origin fail the same
    criterion."""
    assert not same(Broken("size"), body, body.scaled(size=7.3))
    assert not same(Broken("density"), body, body.scaled(density=0.013))
    assert not same(Broken("mirror"), body, body.mirrored(), "right", "left")
    assert not same(Broken("place"), body, elsewhere(body, 1000.125, -17.5))


@pytest.mark.verifies("behaviour")
@every_model
@few
@given(body=sections())
def test_number_and_flags(model, body):
    """The coefficient is finite and never negative; it is the raw value unless a flag says why not."""
    for foot in ("left", "right"):
        result = model.evaluate(body, foot)
        assert isinstance(result, Restitution)
        assert result.model is model
        assert math.isfinite(result.coefficient)
        assert result.coefficient == max(result.raw, 0.0)
        assert (result.flags == (Flag.STOPS,)) == (result.raw <= 0.0)
        assert model.coefficient(body, foot) == result.coefficient


@pytest.mark.verifies(against="r^2 I_new <= I_old", within="1e-12", control="test_energy_criterion_rejects")
@every_model
@few
@given(body=sections())
def test_energy_bound(model, body):
    """No impact creates energy: r^2 I_O' <= I_O for asymmetric bodies, both ways."""
    if not model.keeps_energy:
        pytest.skip("no such promise: see the models that break it on purpose")
    assert bounded(model, body, "left")
    assert bounded(model, body, "right")


@pytest.mark.verifies("behaviour")
def test_no_model_is_left_out():
    """Every registered model is tried, and no others than these two are excused from the energy bound."""
    assert all(kind.trials for kind in rk.restitution.models().values())
    assert {type(model) for model in MODELS} >= set(rk.restitution.models().values())
    # a coefficient by hand does not know the body; an impulse behind k = 1/2 may leave more energy than there was
    assert {model.label for model in MODELS if not model.keeps_energy} == {"fixed:r=0.7", "shifted-impulse:k=0"}


@pytest.mark.verifies("negative control", "a factor 1.001 on the bound, and models that promise no bound")
def test_energy_criterion_rejects():
    """Negative control: a factor 1.001 on the bound, a coefficient by hand, and k = 0 fail for an asymmetric
    body."""
    body = rk.Block(width=2.0, height=1.0).with_feet(0.8, 2.0)
    assert not bounded(Broken("energy"), body, "right")
    for model in (rk.restitution.model("fixed", r=0.99), rk.restitution.model("shifted-impulse", k=0.0)):
        assert not model.keeps_energy
        assert not bounded(model, body, "right")


@pytest.mark.slow
@pytest.mark.verifies(against="the product of both directions is at most 1", within="1e-12", control="within")
@every_model
@few
@given(body=sections())
def test_there_and_back(model, body):
    """An impact onto each foot gains nothing: r_LR r_RL <= 1."""
    assert model.coefficient(body, "left") * model.coefficient(body, "right") <= 1.0 + 1e-12
    control = Broken("energy")
    assert control.coefficient(body, "left") * control.coefficient(body, "right") > 1.0 + 1e-12


@pytest.mark.verifies("behaviour")
def test_a_factor_below_one_breaks_coincident_pivots():
    """What wraps a model, and a coefficient by hand, see the old foot as their value has it."""
    sees = [model.sees_old_foot for model in AT_ONE]
    assert sees == [True, True, False, True]
    below = (Interface(Housner(), 0.9), Interface(Fixed(1.0), 0.9), Fixed(0.9))
    assert not any(model.sees_old_foot for model in below)


@pytest.mark.slow
@pytest.mark.verifies(against="no loss where both feet meet; models that say they break it must", control="within")
@pytest.mark.parametrize("model", [*MODELS, *AT_ONE], ids=lambda model: model.label)
@few
@given(body=sections())
def test_coincident_pivots(model, body):
    """As the feet meet below the centre nothing is lost: 1 - r falls with the gap; KED and its like break
    it."""
    x, (left, right) = body.centre[0], body.feet
    gaps = np.array([1e-2, 1e-3]) * min(right - x, x - left)
    losses = np.array([1.0 - model.coefficient(body.with_feet(x - gap, x + gap)) for gap in gaps])
    # Housner loses 2 gap^2/(I_h/m), and I_h/m > h^2
    vanishes = bool((losses <= 3.0 * (gaps / body.centre[1]) ** 2 + 1e-11).all())
    assert vanishes == model.sees_old_foot


def twins(body):
    """A body's mass, centre, inertia, feet and contact in two points, lying and turned by 1 rad."""
    moments = body.local_moments
    arm = math.sqrt(moments.polar / moments.mass)
    for turn in (0.0, math.asin(min(1.0, moments.y / arm)) * 0.9):
        step = arm * np.array([math.cos(turn), math.sin(turn)])
        middle = np.array([moments.x, moments.y])
        yield rk.MassPoints(
            [middle - step, middle + step],
            [0.5 * moments.mass] * 2,
            feet=body.local_feet,
            contact=body.local_contact,
        )


@pytest.mark.verifies(
    against="bodies of the same mass, centre, inertia and feet", within="1e-8", control="test_inertia_criterion_rejects"
)
@every_model
@few
@given(body=sections())
def test_inertia_alone(model, body):
    """A model marked inertia_only gives dynamically equal bodies one coefficient; the others are told
    apart."""
    assert all(same(model, body, twin) for twin in twins(body)) == model.inertia_only


@pytest.mark.verifies("negative control", "a model that looks at the height of the masses")
def test_inertia_criterion_rejects():
    """Negative control: a model that claims inertia_only but looks at the height of the masses is found
    out."""
    body = rk.Block(width=1.0, height=2.0)
    assert not all(same(Broken("inertia"), body, twin) for twin in twins(body))


@pytest.mark.verifies(
    against="the same rectangle as block, section and array",
    within="1e-9",
    control="test_slenderness_criterion_rejects",
)
@every_model
def test_slenderness_arrays_are_blocks(model):
    """The vectorised coefficients of rectangles are those of Blocks, Sections, and of either foot."""
    ratios = np.array([0.05, 0.3, 0.6, 0.8, 1.0, 2.5, 7.0, 40.0])
    blocks = [rk.Block(width=0.7, height=0.7 * ratio, density=1.0) for ratio in ratios]
    expected = model.of_slenderness(ratios)
    assert [model.coefficient(body, "right") for body in blocks] == pytest.approx(expected, rel=1e-9, abs=1e-13)
    assert [model.coefficient(body, "left") for body in blocks] == pytest.approx(expected, rel=1e-9, abs=1e-13)
    sections = [body.to_section() for body in blocks]
    assert [model.coefficient(body) for body in sections] == pytest.approx(expected, rel=1e-9, abs=1e-13)
    assert model.stops(ratios).tolist() == [model.evaluate(body).flags == (Flag.STOPS,) for body in blocks]
    assert model.of_slenderness(ratios.reshape(2, 4)).tolist() == expected.reshape(2, 4).tolist()


@pytest.mark.verifies("negative control", "a model whose two ways differ")
def test_slenderness_criterion_rejects():
    """Negative control: a model whose two ways differ is not taken for consistent."""
    ratios = np.array([0.8, 2.5])
    per_body = [Broken("slenderness").coefficient(rk.Block(width=1.0, height=ratio)) for ratio in ratios]
    assert per_body != pytest.approx(Broken("slenderness").of_slenderness(ratios), rel=1e-9, abs=0.0)


@pytest.mark.verifies(
    against="0 <= r <= 1, growing with slenderness to its limit", within="1e-7 of the limit", control="within"
)
@every_model
def test_symmetric_range_and_monotony(model):
    """For rectangles 0 <= r <= 1, and r never falls with slenderness; towards l = 1e4 it reaches its
    factor."""
    ratios = np.geomspace(1e-2, 1e4, 61)
    r = model.of_slenderness(ratios)
    assert ((r >= 0.0) & (r <= 1.0)).all()
    assert (np.diff(r) >= -1e-12).all()
    assert r[-1] == pytest.approx(model.slender_limit, abs=1e-7)
    assert not (np.diff(Broken("slenderness").of_slenderness(ratios)) >= -1e-12).all()


@pytest.mark.verifies(against="0 <= r <= 1, equal onto either foot", within="1e-9")
@every_model
@few
@given(body=sections())
def test_symmetric_bodies_stay_in_range(model, body):
    """Any body with equal levers has 0 <= r <= 1, the same onto either foot for models of inertia alone."""
    x, (left, right) = body.centre[0], body.feet
    reach = 0.999 * min(right - x, x - left)
    even = body.with_feet(x - reach, x + reach)
    leftward, rightward = model.coefficient(even, "left"), model.coefficient(even, "right")
    assert 0.0 <= leftward <= 1.0
    assert 0.0 <= rightward <= 1.0
    if model.inertia_only:
        assert leftward == pytest.approx(rightward, rel=1e-9, abs=1e-12)


@pytest.mark.verifies("damage", "slenderness from 1e-200 to 1e200")
@every_model
@pytest.mark.parametrize("ratio", [1e-200, 1e-12, 1e12, 1e150, 1e200])
def test_extreme_slenderness_is_a_number_or_a_refusal(model, ratio):
    """Ratios far beyond any body give a coefficient in [0, 1] or a clear refusal, never NaN or a warning."""
    try:
        r = model.of_slenderness([ratio])
    except rk.errors.InvalidValueError as error:
        assert "slenderness" in str(error)  # noqa: PT017
    else:
        assert 0.0 <= r[0] <= 1.0


@pytest.mark.verifies("behaviour")
@pytest.mark.parametrize("kind", KINDS.values(), ids=list(KINDS))
def test_account_of_itself(kind):
    """Every registered model states title, reference, assumptions, domain and known defects, and has a
    docstring."""
    for words in (
        kind.title,
        kind.reference,
        kind.domain,
        kind.__doc__ or "",
        *kind.assumptions,
        *kind.known_defects,
    ):
        assert len(words.split()) >= 3
        assert words != "not stated"
    assert kind.assumptions
    assert kind.known_defects
    assert Broken.reference == "not stated"


@pytest.mark.verifies("behaviour")
@every_model
def test_label_is_a_name(model):
    """The label of a model, given as a name, is the same model."""
    again = rk.restitution.model(model.label)
    assert again.label == model.label
    assert type(again) is type(model)
    body = rk.Block(width=1.0, height=3.0)
    # labels print parameters with four digits or more
    assert again.coefficient(body) == pytest.approx(model.coefficient(body), rel=1e-4)
