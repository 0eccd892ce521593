"""Tables of motions and of record files."""

from typing import Annotated, Any

from pydantic import Field, model_validator

from rocking.errors import InvalidValueError
from rocking.spec.fields import JobTable, Names, Positive, Seed, Text, key

OF_FILES = {"format", "units", "time_step", "skip", "component", "vertical", "vertical_file", "process"}
"""Keys of a motion that are allowed for record files only."""

_SOURCE = "one source is required"


class FileKeys(JobTable):
    """Format, unit, time step and skipped lines of a record file."""

    format: Text | None = key(
        "format of the record file from rocking record formats", usual="detected from the content",
        allowed="a name from `rocking record formats`",
    )  # fmt: skip
    units: Text | None = key(
        "unit of a record file without unit: m/s2, cm/s2, mm/s2, gal, g, g/10, mg",
        usual="unit in the file; required without", allowed="a unit of the list",
    )  # fmt: skip
    time_step: Positive | None = key(
        "time step of a record file without time step [s]", usual="time step in the file; required without"
    )
    skip: int | None = key(
        "number of lines to skip at the top of a text file", None, usual="detected from the content", ge=0, le=100_000
    )


class MotionKeys(FileKeys):
    """Source, processing and scaling of motions."""

    synthetic: Text | None = key(
        "family of synthetic motions: firm-ground, soft-ground, point-source and more", usual=_SOURCE,
        allowed="a family of the page Names of values",
    )  # fmt: skip
    component: Text | None = key(
        "name of the horizontal component in the file", usual="the only horizontal component; in studies all",
        allowed="a component of the file",
    )  # fmt: skip
    vertical: Text | None = key(
        "name of the vertical component in the file", usual="no vertical motion", allowed="a component of the file"
    )
    vertical_file: Text | None = key(
        "file of the vertical component, if separate", usual="no vertical motion", allowed="a record file"
    )
    process: Names | None = key(
        "processing steps of a record: mean; bandpass:low=0.1,high=25; taper", usual="no processing",
        allowed="steps of the page Names of values",
    )  # fmt: skip
    scale: float = key(
        "scale factor of the ground acceleration [-]",
        1.0,
        allowed="any except 0: a negative factor reverses the motion",
    )
    seed: Seed | None = key("seed of the synthetic motions", usual="0; in an inventory 1")
    pga: Positive | None = key(
        "peak ground acceleration of the scaled synthetic motions [m/s2]", usual="motions of the family, not scaled"
    )
    pgv: Positive | None = key(
        "peak ground velocity of the scaled synthetic motions [m/s]", usual="motions of the family, not scaled"
    )

    def _one_source(self, keys: dict[str, set[str]]) -> str:
        """Return the only source of the motion. Raise an error if a key belongs to another source."""
        source = self.chosen(*keys)
        stated = {name for name in self.model_fields_set if getattr(self, name) is not None}
        odd = sorted(stated & set().union(*keys.values()) - keys[source])
        if odd:
            raise InvalidValueError(
                "{keys} is not allowed with {source}. Allowed: {names}.", source=source, keys=", ".join(odd),
                names=", ".join(sorted(keys[source])),
            )  # fmt: skip
        if self.scale == 0.0:
            raise InvalidValueError("scale must not be 0.")
        return source


class OneMotionTable(MotionKeys):
    """One pulse, one record, or one motion of a synthetic family."""

    pulse: Text | None = key(
        "pulse, such as sine:amplitude=3,period=0.8", usual=_SOURCE, allowed="a pulse of the page Names of values"
    )
    record: Text | None = key("record file", usual=_SOURCE, allowed="an existing file")
    member: Annotated[int, Field(ge=0, lt=10_000_000)] | None = key(
        "index of the motion in the synthetic family, from 0", usual="0"
    )

    @model_validator(mode="after")
    def _whole(self) -> "OneMotionTable":
        self._check_sources()
        return self

    def _check_sources(self) -> None:
        own = {"seed", "member", "pga", "pgv", "time_step", "scale"}
        self._one_source({"pulse": {"scale"}, "record": {*OF_FILES, "scale"}, "synthetic": own})
        if self.pga is not None and self.pgv is not None:
            raise InvalidValueError("Use pga or pgv, not both.")


class _Along(JobTable):
    """Motions of a 3D body along x, y and z (up)."""

    x: OneMotionTable | None = key("motion along x", usual="no motion along x")
    y: OneMotionTable | None = key("motion along y", usual="no motion along y")
    z: OneMotionTable | None = key("motion along z, upwards", usual="no motion along z")

    @property
    def components(self) -> dict[str, OneMotionTable]:
        """Motions by axis; empty for a single motion."""
        along = {"x": self.x, "y": self.y, "z": self.z}
        return {axis: table for axis, table in along.items() if table is not None}

    def _check_components(self) -> None:
        """Refuse keys that are not allowed with components."""
        if odd := sorted(self.model_fields_set - {"x", "y", "z", "scale"}):
            raise InvalidValueError("Give {keys} separately for the motions along x, y and z.", keys=", ".join(odd))
        if self.x is not None and self.z is not None and (self.x.vertical or self.x.vertical_file):
            raise InvalidValueError("The vertical motion appears twice: with the motion along x, and as z. Remove one.")


class ComponentsTable(_Along, OneMotionTable):
    """One motion, or for a 3D body motions along x, y and z (up)."""

    def _check_sources(self) -> None:
        self._check_components() if self.components else super()._check_sources()


class MotionTable(_Along, MotionKeys):
    """Records, pulses or synthetic motions, or for a 3D body one motion along x, y and z (up)."""

    records: Names | None = key(
        "record files, folder of record files, pattern such as *.at2, or list in a .csv file", usual=_SOURCE,
        allowed="existing files or folders",
    )  # fmt: skip
    files: dict[Text, FileKeys] | None = key(
        'options of single files, in place of the common options: one table per file name, as motions.files."a.txt"',
        usual="common options of all files",
    )
    pulse: Names | None = key(
        "pulses, such as sine:amplitude=3,period=0.8", usual=_SOURCE, allowed="pulses of the page Names of values"
    )
    count: Annotated[int, Field(ge=1, le=10_000_000)] | None = key(
        "number of synthetic motions, or of records selected for a target spectrum",
        usual="required with synthetic; all records with target",
    )
    target: Text | None = key(
        "target spectrum for scaling: eurocode8:ag=0.25g,ground=C,type=1, asce7:sds=1g,sd1=0.6g,tl=8, or a file",
        usual="no scaling to a spectrum", allowed="a spectrum of the page Names of values, or an existing file",
    )  # fmt: skip
    periods: Annotated[list[Positive], Field(min_length=2, max_length=2)] | None = key(
        "shortest and longest period of the comparison with the target spectrum [s]", usual="0.1 and 2",
        allowed="2 increasing numbers > 0",
    )  # fmt: skip
    mirrored: bool = key("add every record with reversed horizontal components", False)

    @model_validator(mode="after")
    def _whole(self) -> "MotionTable":
        if self.components:
            self._check_components()
            return self
        own = {"count", "seed", "pga", "pgv", "time_step"}
        chosen = {"target", "periods", "count"}
        of_records = {*OF_FILES, "files", *chosen, "scale", "mirrored"}
        source = self._one_source({"records": of_records, "pulse": {"scale"}, "synthetic": own})
        if source == "synthetic" and self.count is None:
            raise InvalidValueError("count is missing. Add the number of synthetic motions.")
        if source == "records" and self.target is None and (odd := sorted(chosen & self.model_fields_set)):
            raise InvalidValueError(
                "{parameter} of records needs target. Add the target spectrum, or remove {parameter}.", parameter=odd[0]
            )
        return self

    @property
    def size(self) -> int:
        """Number of motions. A folder, a pattern, a list, or components along x, y and z count as 1."""
        return self.count or len(self.records or self.pulse or [1])

    @property
    def file_options(self) -> dict[str, dict[str, Any]]:
        """Stated options of single record files, by file name."""
        return {name: table.model_dump(exclude_none=True) for name, table in (self.files or {}).items()}
