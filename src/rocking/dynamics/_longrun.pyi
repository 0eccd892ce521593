"""Types of the long-run engine, which is compiled from engine/longrun."""

from rocking.conventions import FloatArray

def many(
    bodies: FloatArray,
    sines: FloatArray,
    starts: FloatArray,
    results: FloatArray,
    sections: FloatArray,
    impacts: FloatArray,
    law: FloatArray,
    settled: int,
    vectors: int,
    linear: bool,
    overturned: float,
    rest: float,
    step_error: float,
    threads: int,
    isa: str = "",
) -> None: ...
def over_impacts(
    bodies: FloatArray,
    sines: FloatArray,
    starts: FloatArray,
    ends: FloatArray,
    law: FloatArray,
    n: int,
    parameter: int,
    linear: bool,
    overturned: float,
    rest: float,
    step_error: float,
    threads: int,
    isa: str = "",
) -> None: ...
