from typing import Any

from rocking.conventions import FloatArray, IntArray

class Library:
    def __init__(self) -> None: ...
    def add_body(self, mass: float, inertia: FloatArray, **tables: Any) -> None: ...
    def add_nobody(self) -> None: ...
    def add_motion(self, times: FloatArray, rows: FloatArray) -> None: ...
    def run(
        self,
        numbers: FloatArray,
        choices: IntArray,
        results: FloatArray,
        counts: IntArray,
        rest_speed: float,
        tolerance: float,
        most_events: int,
        threads: int,
    ) -> None: ...
    def trace(
        self,
        numbers: FloatArray,
        choices: IntArray,
        results: FloatArray,
        counts: IntArray,
        rest_speed: float,
        tolerance: float,
        most_events: int,
    ) -> tuple[FloatArray, FloatArray, IntArray, IntArray, IntArray, float, bool]: ...
