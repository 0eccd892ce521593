from typing import Any

def instruction_sets() -> list[str]: ...

class Stock:
    def __init__(
        self,
        bodies: Any,
        corners: Any,
        vertices: Any,
        kept: Any,
        degree: int,
        places: Any,
        times: Any,
        accelerations: Any,
        isa: str,
    ) -> None: ...
    def run(self, numbers: Any, choices: Any, results: Any, counts: Any, **limits: Any) -> None: ...
    def trace(self, numbers: Any, choices: Any, results: Any, counts: Any, **limits: Any) -> Any: ...
