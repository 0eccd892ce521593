"""SMC as David Boore's programs write it: 5 columns of 14 characters, marked by whole number 47 of the header."""

from typing import ClassVar

from rocking.motions.formats.smc_usgs import SmcUsgs


class SmcBoore(SmcUsgs):
    """SMC in high precision; all but the columns of the samples is as in `SmcUsgs`."""

    name: ClassVar[str] = "smc-boore"
    title: ClassVar[str] = "SMC of Boore's TSPP programs in high precision, 5 columns of 14 characters"
    notes: ClassVar[str] = (
        "Accelerations are in cm/s2 by the format's definition, also where the first line says UNKNOWN: make sure that "
        "such a file is no velocity. What its lines of comment say of units is about the file it was made from."
    )
    _per_line: ClassVar[int] = 5
    _width: ClassVar[int] = 14
    _decimals: ClassVar[int] = 7
    _precision: ClassVar[int] = 8
