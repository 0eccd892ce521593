"""Names, parameters, the user's own model, and the interface factor."""

import numpy as np
import pytest

import rocking as rk
from rocking.errors import InvalidValueError, RockingError, UnknownModelError
from rocking.restitution import Interface, Ked, ShiftedImpulse, model, models, register, registry

BODY = rk.Block(width=1.0, height=2.0).with_feet(0.1, 1)


class Half(rk.restitution.RestitutionModel):
    """A user's own model."""

    name = "half"

    def raw_coefficient(self, body, foot):
        return 0.5


@pytest.fixture
def clean_registry(monkeypatch):
    """A registry that forgets what a test registers."""
    monkeypatch.setattr(registry, "_MODELS", dict(registry._MODELS))


def test_names():
    """The registry holds the promised names, and changing the returned dict changes nothing."""
    promised = {
        "housner",
        "ked",
        "horizontal-momentum",
        "shifted-impulse",
        "distributed-impulse",
        "plastic-winkler",
        "contact-bed",
        "fixed",
    }
    assert promised <= set(models())
    models().clear()
    assert promised <= set(models())
    assert all(kind.name == name for name, kind in models().items())


@pytest.mark.parametrize("which", ["", "K E D", "kdd", "housner ked", "0.9*", "*", "ked;", "interface"])
def test_unknown_names(which):
    """An unknown name is refused with the list of those that exist."""
    with pytest.raises(RockingError, match=r"unknown restitution model .*housner.*ked|must be a number"):
        rk.coefficient_of_restitution(BODY, which)


@pytest.mark.parametrize(
    "which", [None, True, "0.9".encode, ["ked"], Ked, b"ked", object()], ids=lambda value: type(value).__name__
)
def test_what_is_no_model(which):
    """What is neither a name, a model object nor a number is refused: also the class instead of an object."""
    with pytest.raises(InvalidValueError, match="restitution must be a model, its name, a coefficient"):
        rk.coefficient_of_restitution(BODY, which)
    with pytest.raises(UnknownModelError, match="a restitution model must be a name or a RestitutionModel object"):
        rk.restitution.model(which)


PARAMETERS = {
    "unknown": ("ked", {"k": 0.5}, UnknownModelError, "'ked' accepts no parameters, got k"),
    "other": ("shifted-impulse", {"q": 0.5}, UnknownModelError, "accepts k, got q"),
    "missing": ("fixed", {}, UnknownModelError, "accepts r, got none"),
    "k above 1": (
        "shifted-impulse",
        {"k": 1.2},
        InvalidValueError,
        r"k must be in \[0, 1\], got 1.2; the impulse acts",
    ),
    "k below 0": ("shifted-impulse", {"k": -0.1}, InvalidValueError, r"k must be in \[0, 1\], got -0.1"),
    "k NaN": ("shifted-impulse", {"k": float("nan")}, InvalidValueError, "k must be finite"),
    "k word": ("shifted-impulse", {"k": "0.5"}, InvalidValueError, "k must be a number"),
    "k bool": ("shifted-impulse", {"k": True}, InvalidValueError, "k must be a number"),
    "k array": ("shifted-impulse", {"k": np.array([0.5, 0.6])}, InvalidValueError, "k must be one number"),
    "k None": ("shifted-impulse", {"k": None}, InvalidValueError, "k must be a number"),
    "q inf": ("distributed-impulse", {"q": float("inf")}, InvalidValueError, "q must be finite"),
    "q negative": ("distributed-impulse", {"q": -1e-9}, InvalidValueError, r"q must be in \[0, 1e\+06\]"),
    "q NaN": ("distributed-impulse", {"q": float("nan")}, InvalidValueError, "q must be finite"),
    "r above 1": ("fixed", {"r": 1.0001}, InvalidValueError, r"r must be in \[0, 1\].*energy ratio or a percentage"),
    "r percent": ("fixed", {"r": 90}, InvalidValueError, r"r must be in \[0, 1\], got 90"),
    "r negative": ("fixed", {"r": -0.5}, InvalidValueError, r"r must be in \[0, 1\]"),
    "r word": ("fixed", {"r": "x"}, InvalidValueError, "r must be a number"),
    "eta 0": ("ked", {"eta": 0.0}, InvalidValueError, r"eta must be in \(0, 1\], got 0; the interface factor"),
    "eta above 1": ("ked", {"eta": 1.0001}, InvalidValueError, r"eta must be in \(0, 1\], got 1.0001"),
    "eta negative": ("ked", {"eta": -1.0}, InvalidValueError, r"eta must be in \(0, 1\]"),
    "eta NaN": ("ked", {"eta": float("nan")}, InvalidValueError, "eta must be finite"),
    "eta word": ("ked", {"eta": "1"}, InvalidValueError, "eta must be a number"),
    "eta bool": ("ked", {"eta": True}, InvalidValueError, "eta must be a number"),
    "eta None": ("ked", {"eta": None}, InvalidValueError, "eta must be a number"),
    "text k": ("shifted-impulse:k=1.2", {}, InvalidValueError, r"k must be in \[0, 1\]"),
    "text word": ("shifted-impulse:k=x", {}, InvalidValueError, "k must be a number, got 'x'"),
    "text without value": ("shifted-impulse:k", {}, UnknownModelError, "write parameters as name:k=0.6"),
    "text other": ("shifted-impulse:q=1", {}, UnknownModelError, "accepts k, got q"),
    "text eta": ("1.2*ked", {}, InvalidValueError, r"eta must be in \(0, 1\]"),
    "text eta word": ("x*ked", {}, InvalidValueError, "eta must be a number, got 'x'"),
    "text eta NaN": ("nan*ked", {}, InvalidValueError, "eta must be finite"),
    "eta 2 times 1/2": ("0.5*ked", {"eta": 2.0}, InvalidValueError, r"eta must be in \(0, 1\]"),
    "eta -1 times -1": ("-1*ked", {"eta": -1.0}, InvalidValueError, r"eta must be in \(0, 1\]"),
    "object and parameters": (Ked(), {"k": 0.5}, UnknownModelError, "accepts no further parameters, got k"),
    "object, eta bool": (Ked(), {"eta": True}, InvalidValueError, "eta must be a number"),
    "object, eta array": (Ked(), {"eta": np.ones(2)}, InvalidValueError, "eta must be one number"),
}


@pytest.mark.parametrize(("which", "parameters", "kind", "words"), PARAMETERS.values(), ids=list(PARAMETERS))
def test_parameters_that_are_none(which, parameters, kind, words):
    """Wrong parameters give the right error with value, range and cause; never a number."""
    with pytest.raises(kind, match=words):
        rk.coefficient_of_restitution(BODY, which, **parameters)


@pytest.mark.parametrize("body", [None, "block", 4.0, rk.Block, {"width": 1}], ids=repr)
def test_what_is_no_body(body):
    """A coefficient of something that is no body is refused."""
    for name in ("ked", "housner", "plastic-winkler"):
        with pytest.raises(InvalidValueError, match="body must be a Block, Section or MassPoints"):
            rk.coefficient_of_restitution(body, name)


@pytest.mark.parametrize("foot", ["up", "RIGHT", None, 1, ["left"], ""], ids=repr)
def test_what_is_no_foot(foot):
    """The new foot is "left" or "right" for every model, also those that do not use it."""
    for name, parameters in (("ked", {}), ("housner", {}), ("fixed", {"r": 0.5})):
        with pytest.raises(InvalidValueError, match='foot must be "left" or "right"'):
            rk.coefficient_of_restitution(BODY, name, foot=foot, **parameters)


@pytest.mark.parametrize(
    "ratios",
    [0.0, -1.0, [1.0, float("nan")], [float("inf")], "4", ["4"], [True], [1j], None, [[1.0], [1.0, 2.0]]],
    ids=repr,
)
def test_what_is_no_slenderness(ratios):
    """Slenderness ratios are finite numbers above zero for every model."""
    for name in models():
        found = model(name, **({"r": 0.5} if name == "fixed" else {}))
        with pytest.raises(InvalidValueError, match=r"^slenderness_ratio must be"):
            found.of_slenderness(ratios)


def test_text_forms():
    """Parameters and factor in the name equal those given as arguments; spaces do no harm."""
    expected = 0.98 * ShiftedImpulse(k=0.6).coefficient(BODY)
    for words in ("0.98*shifted-impulse:k=0.6", " 0.98 * shifted-impulse: k = 0.6 "):
        assert rk.coefficient_of_restitution(BODY, words) == pytest.approx(expected, rel=1e-15, abs=0.0)
    assert rk.coefficient_of_restitution(BODY, "shifted-impulse", k=0.6, eta=0.98) == pytest.approx(
        expected, rel=1e-15, abs=0.0
    )
    assert rk.coefficient_of_restitution(BODY, "0.5*ked", eta=0.5) == pytest.approx(0.25 * Ked().coefficient(BODY))
    assert expected != pytest.approx(ShiftedImpulse(k=0.6).coefficient(BODY))


def test_own_model():
    """A class with a name and an equation is a model: by object at once, by name after `register`."""
    assert rk.coefficient_of_restitution(BODY, Half()) == 0.5
    assert rk.coefficient_of_restitution(BODY, Half(), eta=0.5) == 0.25
    assert Half().of_slenderness([1.0, 4.0]).tolist() == [0.5, 0.5]
    assert Half().parameters == {}
    assert Half().label == "half"
    with pytest.raises(UnknownModelError, match="unknown restitution model 'half'"):
        model("half")


@pytest.mark.usefixtures("clean_registry")
def test_register():
    """`register` makes a model known by name, twice the same is no harm, another of that name is refused."""
    assert register(Half) is Half
    assert register(Half) is Half
    assert rk.coefficient_of_restitution(BODY, "half") == 0.5

    class Other(Half):
        """Same name."""

    with pytest.raises(InvalidValueError, match="a restitution model named 'half' exists already"):
        register(Other)


@pytest.mark.parametrize("value", [None, 3, "ked", int, Ked(), Half()], ids=lambda value: type(value).__name__)
@pytest.mark.usefixtures("clean_registry")
def test_register_refuses(value):
    """Only subclasses of RestitutionModel with a name can be registered."""
    with pytest.raises(InvalidValueError, match="a restitution model must be a subclass"):
        register(value)

    class Nameless(rk.restitution.RestitutionModel):
        """No name."""

        def raw_coefficient(self, body, foot):
            return 0.5

    with pytest.raises(InvalidValueError, match="Nameless needs a class attribute name"):
        register(Nameless)


@pytest.mark.parametrize("value", [float("nan"), float("inf"), None, "0.5", 1j, True, [0.5]], ids=repr)
def test_own_model_that_returns_no_number(value):
    """A model that returns no finite number is refused with its name, never passed on; arrays of slenderness too."""

    class Bad(Half):
        """Returns what it should not."""

        def raw_coefficient(self, body, foot):
            return value

    with pytest.raises(InvalidValueError, match="coefficient of model half must be"):
        rk.coefficient_of_restitution(BODY, Bad())
    if isinstance(value, float):
        with pytest.raises(InvalidValueError, match="coefficient of model half must be"):
            Bad().of_slenderness([1.0, 2.0])


def test_interface():
    """The wrapper multiplies by eta, per body and for arrays, and tells of the model inside."""
    wrapped = Interface(ShiftedImpulse(k=0.6), eta=0.9)
    assert wrapped.coefficient(BODY) == pytest.approx(0.9 * ShiftedImpulse(k=0.6).coefficient(BODY), rel=1e-15, abs=0.0)
    inside = ShiftedImpulse(k=0.6).of_slenderness([0.3, 3.0])
    assert wrapped.of_slenderness([0.3, 3.0]) == pytest.approx(0.9 * inside, rel=1e-15, abs=0.0)
    assert wrapped.label == "0.9*shifted-impulse:k=0.6"
    assert wrapped.parameters == {"k": 0.6, "eta": 0.9}
    assert (wrapped.domain, wrapped.inertia_only) == (ShiftedImpulse.domain, True)
    assert not Interface(Ked(), eta=0.9).inertia_only
    assert Interface(Ked(), eta=1.0).coefficient(BODY) == Ked().coefficient(BODY)
    assert wrapped.coefficient(BODY) != pytest.approx(ShiftedImpulse(k=0.6).coefficient(BODY))


@pytest.mark.parametrize("inner", ["ked", None, Ked, 0.9], ids=repr)
def test_interface_wraps_models_only(inner):
    """Something that is no model cannot be wrapped."""
    with pytest.raises(RockingError, match="model"):
        Interface(inner, eta=0.9)
