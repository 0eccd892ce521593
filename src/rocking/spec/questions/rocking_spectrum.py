"""Rocking spectra."""

from rocking.spec.fields import JobTable, Numbers, key

OWN_BLOCKS = "a spectrum makes its own blocks; of a body, plane or in space, a map over semi_diagonal shows all sizes"


class SpectrumTable(JobTable):
    """The blocks of rocking spectra."""

    slenderness_angles: Numbers = key("slenderness angles alpha = atan(b/h) [rad]", ...)
    periods: Numbers = key("periods 2 pi / p [s]", ...)
    scale: float = key("factor on the acceleration of the ground [-]", 1.0)
