"""One family of errors: everything this package refuses is a `RockingError`."""


class RockingError(Exception):
    """Base of every error that this package raises on purpose."""


class InvalidValueError(RockingError, ValueError):
    """A number or a word is outside its allowed range."""


class GeometryError(InvalidValueError):
    """An outline, a hole, a foot or a set of regions does not describe a body."""


class AsymmetricBodyError(RockingError, AttributeError):
    """A body that is not symmetric was asked for a quantity that depends on the side."""


class UnknownModelError(RockingError, LookupError):
    """No restitution model of that name, or a model was given parameters it does not have."""


class BodyFileError(RockingError):
    """A body file (TOML, WKT, GeoJSON, DXF) cannot be read as a body."""


class RecordError(RockingError):
    """A ground-motion file cannot be read: not recognised, ambiguous, damaged, or at odds with its own header."""


class MissingExtraError(RockingError, ImportError):
    """A feature needs an optional dependency that is not installed."""


class PureRockingWarning(UserWarning):
    """Pure rocking is not credible for a response: the body would slide or fly, see `simulate_with_contact`."""


class SlowEngineWarning(UserWarning):
    """The fast engine was not built, and the reference engine serves in its place."""
