from typing import Any

from rocking.conventions import FloatArray, IntArray

class Library:
    def __init__(self, data: FloatArray, places: IntArray, steps: FloatArray) -> None: ...
    def run(
        self,
        numbers: FloatArray,
        restraints: FloatArray,
        choices: IntArray,
        results: FloatArray,
        counts: IntArray,
        of_restraints: FloatArray,
        gravity: float,
        rest_speed: float,
        tolerance: float,
        most_events: int,
        linear: bool,
        threads: int,
    ) -> None: ...
    def trace(
        self,
        numbers: FloatArray,
        restraints: FloatArray,
        choices: IntArray,
        samples: FloatArray,
        elongation: FloatArray,
        force: FloatArray,
        restraint_work: FloatArray,
        gravity: float,
        rest_speed: float,
        tolerance: float,
        most_events: int,
        linear: bool,
    ) -> tuple[Any, ...]: ...
