"""Settings under which one machine computes as others do, and the tests under each of them.

OpenBLAS picks its kernels by the processor, numpy some of its functions, the compiled engines their instruction set,
and the C library its versions with fused multiply-add; each can be told to do as on another processor.
``python tests/portable.py [--setting NAME] [arguments of pytest]`` runs the tests under one setting, or under each.
"""

import argparse
import json
import os
import subprocess
import sys
from pathlib import Path

NO_AVX512, LEAST = "no AVX-512, AMD", "least processor"
_WIDE = ("AVX512F", "AVX512VL", "AVX512BW", "AVX512DQ")
_FEATURES = """
import json
from numpy._core import _multiarray_umath as n
print(json.dumps([f for f in n.__cpu_dispatch__ if n.__cpu_features__.get(f)]))
"""
_ENGINES = """
from rocking.dynamics.plane import fast_engine
print(*(fast_engine.instruction_sets() if fast_engine.available() else []))
"""


def settings() -> dict[str, dict[str, str]]:
    """Environment variables by the name of the setting; none of them where this processor cannot do as that one."""
    # numpy warns of features that it has no code for or the processor lacks; what is listed here it has
    features = json.loads(_said(_FEATURES))
    wide = [f for f in features if "AVX512" in f or f == "X86_V4"]
    fused = "FMA3" in features or "X86_V3" in features
    found = {
        "OpenBLAS of AVX-512": {"OPENBLAS_CORETYPE": "SkylakeX" if wide else ""},
        "OpenBLAS of AVX": {"OPENBLAS_CORETYPE": "Sandybridge"},
        "no AVX-512, Intel": {
            "OPENBLAS_CORETYPE": "Haswell" if fused else "", "ROCKING_ISA": "avx2",
            "NPY_DISABLE_CPU_FEATURES": " ".join(wide), "GLIBC_TUNABLES": _hidden(*_WIDE),
        },
        NO_AVX512: {
            "OPENBLAS_CORETYPE": "Zen" if fused else "", "ROCKING_ISA": "avx2",
            "NPY_DISABLE_CPU_FEATURES": " ".join(wide), "GLIBC_TUNABLES": _hidden(*_WIDE),
        },
        LEAST: {
            "OPENBLAS_CORETYPE": "Prescott", "ROCKING_ISA": "plain", "NPY_DISABLE_CPU_FEATURES": " ".join(features),
            "GLIBC_TUNABLES": _hidden("AVX2", "FMA", "FMA4", *_WIDE),
        },
    }  # fmt: skip
    known = _said(_ENGINES).split()
    return {
        name: kept
        for name, given in found.items()
        if (kept := {key: value for key, value in given.items() if value and (key != "ROCKING_ISA" or value in known)})
    }


def _hidden(*features: str) -> str:
    return "glibc.cpu.hwcaps=" + ",".join(f"-{feature}" for feature in features)


def _said(program: str) -> str:
    return subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout


def main(names: list[str], arguments: list[str]) -> int:
    """Run pytest under the named settings, or under all; return the number of settings under which a test failed."""
    failed, every = [], settings()
    for name in names or every:
        if not every[name]:
            print(f"== {name}: skipped, this processor cannot imitate that one", flush=True)
            continue
        print(f"== {name}: {every[name]}", flush=True)
        command = [sys.executable, "-m", "pytest", *arguments]
        if subprocess.run(command, env=os.environ | every[name], cwd=Path(__file__).parents[1], check=False).returncode:
            failed.append(name)
    print("failed: " + ", ".join(failed) if failed else "passed under every setting")
    return len(failed)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description="Run pytest under settings that imitate other processors.")
    parser.add_argument("--setting", action="append", default=[], help="name of a setting; repeatable [default: all]")
    given, rest = parser.parse_known_args()
    sys.exit(main(given.setting, rest))
