"""Tables of motions and of record files."""

from typing import Annotated, Any

from pydantic import Field, model_validator

from rocking.errors import InvalidValueError
from rocking.spec.fields import JobTable, Names, Positive, Seed, Text, key

OF_FILES = {"format", "units", "time_step", "skip", "component", "vertical", "vertical_file", "process"}
"""Keys of a motion that are for record files only."""


class FileKeys(JobTable):
    """Options of a record file: its format, unit and time step, and lines to skip."""

    format: Text | None = key("format of the record file, if not found by content: see rocking record formats")
    units: Text | None = key("unit of the record where its file states none: m/s2, cm/s2, mm/s2, gal, g, g/10, mg")
    time_step: Positive | None = key("step between samples where the file does not state it [s]")
    skip: int | None = key("lines at the top of a text file that are passed over", None, ge=0, le=100_000)


class MotionKeys(FileKeys):
    """What one motion, or several, are made of."""

    synthetic: Text | None = key("family of synthetic motions: firm-ground, soft-ground, point-source and more")
    component: Text | None = key("horizontal component of the file, by name")
    vertical: Text | None = key("vertical component, by name")
    vertical_file: Text | None = key("file of the vertical component, where it has its own")
    process: Names | None = key("steps that a record goes through: mean; bandpass:low=0.1,high=25; taper")
    scale: float = key("factor on the acceleration of the ground [-]", 1.0)
    seed: Seed | None = key("seed of the synthetic motions")
    pga: Positive | None = key("peak ground acceleration to which synthetic motions are scaled [m/s2]")
    pgv: Positive | None = key("peak ground velocity to which synthetic motions are scaled [m/s]")

    def _one_source(self, keys: dict[str, set[str]]) -> str:
        """Return the only source of the motion, after refusing keys of another."""
        source = self.chosen(*keys)
        stated = {name for name in self.model_fields_set if getattr(self, name) is not None}
        odd = sorted(stated & set().union(*keys.values()) - keys[source])
        if odd:
            raise InvalidValueError(
                "{source} takes no {keys}; allowed beside it: {names}", source=source, keys=", ".join(odd),
                names=", ".join(sorted(keys[source])),
            )  # fmt: skip
        if self.scale == 0.0:
            raise InvalidValueError("scale must not be 0: nothing would move")
        return source


class OneMotionTable(MotionKeys):
    """One pulse, one record, or one motion of a synthetic family."""

    pulse: Text | None = key("a pulse such as sine:amplitude=3,period=0.8")
    record: Text | None = key("a record file")
    member: Annotated[int, Field(ge=0, lt=10_000_000)] | None = key("which motion of the synthetic family, from 0")

    @model_validator(mode="after")
    def _whole(self) -> "OneMotionTable":
        self._check_sources()
        return self

    def _check_sources(self) -> None:
        own = {"seed", "member", "pga", "pgv", "time_step", "scale"}
        self._one_source({"pulse": {"scale"}, "record": {*OF_FILES, "scale"}, "synthetic": own})
        if self.pga is not None and self.pgv is not None:
            raise InvalidValueError("motions can be scaled to pga or to pgv, not to both")


class _Along(JobTable):
    """A motion along each of the axes x, y and z of a body in space; z is up."""

    x: OneMotionTable | None = key("motion along x")
    y: OneMotionTable | None = key("motion along y")
    z: OneMotionTable | None = key("motion along z, upwards")

    @property
    def components(self) -> dict[str, OneMotionTable]:
        """The motions by their axis; none where there is one motion alone."""
        along = {"x": self.x, "y": self.y, "z": self.z}
        return {axis: table for axis, table in along.items() if table is not None}

    def _check_components(self) -> None:
        """Refuse what does not go with components."""
        if odd := sorted(self.model_fields_set - {"x", "y", "z", "scale"}):
            raise InvalidValueError("{keys} stands with each of the motions along x, y and z", keys=", ".join(odd))
        if self.x is not None and self.z is not None and (self.x.vertical or self.x.vertical_file):
            raise InvalidValueError("the vertical motion is given twice: beside the one along x, and along z")


class ComponentsTable(_Along, OneMotionTable):
    """One motion, or one along each of the axes x, y and z of a body in space; z is up."""

    def _check_sources(self) -> None:
        self._check_components() if self.components else super()._check_sources()


class MotionTable(_Along, MotionKeys):
    """Records, pulses, a family of synthetic motions, or one motion along x, y and z of a body in space; z is up."""

    records: Names | None = key("record files, a folder of them, a pattern such as *.at2, or a list in a .csv file")
    files: dict[Text, FileKeys] | None = key(
        'options of single files, in place of those for all files: one table per file name, [motions.files."a.txt"]'
    )
    pulse: Names | None = key("pulses such as sine:amplitude=3,period=0.8")
    count: Annotated[int, Field(ge=1, le=10_000_000)] | None = key(
        "how many synthetic motions, or records chosen for a target"
    )
    target: Text | None = key(
        "spectrum that records are scaled to: eurocode8:ag=0.25g,ground=C,type=1, asce7:sds=1g,sd1=0.6g,tl=8, a file"
    )
    periods: Annotated[list[Positive], Field(min_length=2, max_length=2)] | None = key(
        "first and last period of a target that count, 0.1 and 2 if not given [s]"
    )
    mirrored: bool = key("every record also with its horizontal components turned round", False)

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
            raise InvalidValueError("count is missing: how many synthetic motions?")
        if source == "records" and self.target is None and (odd := sorted(chosen & self.model_fields_set)):
            raise InvalidValueError(
                "{parameter} of records goes with target, the spectrum that they are chosen for", parameter=odd[0]
            )
        return self

    @property
    def size(self) -> int:
        """Number of motions; of a folder, a pattern or a list, number of names; 1 for components along x, y and z."""
        return self.count or len(self.records or self.pulse or [1])

    @property
    def file_options(self) -> dict[str, dict[str, Any]]:
        """The options of single record files, by their names; keys that are not stated are absent."""
        return {name: table.model_dump(exclude_none=True) for name, table in (self.files or {}).items()}
