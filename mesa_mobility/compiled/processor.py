"""Vectors as wide as the processor has them.

LLVM uses vectors of 256 bits on Intel's processors, though they have 512: wider ones once slowed
their clock. The loops over 8 options are wide enough for 512 bits, and a run takes a tenth less
time with them (decision record 7). Results are the same to the last byte.
"""

from __future__ import annotations

from llvmlite import binding
from numba import config
from numba.core.registry import cpu_target

_WIDE = "-prefer-256-bit"
"""The preference of LLVM that is switched off."""


def use_wide_vectors() -> None:
    """Let Numba compile for 512 bits where the processor has them.

    This holds for all that Numba compiles in this process. Nothing changes where somebody has set
    what it compiles for, or where Numba has made its compiler already.
    """
    if is_chosen() or "_toplevel_target_context" in vars(cpu_target):
        return
    try:
        features = binding.get_host_cpu_features()
    except RuntimeError:  # LLVM does not know
        return
    if features.get("avx512f"):
        config.CPU_FEATURES = f"{features.flatten()},{_WIDE}"


def is_chosen() -> bool:
    """Whether somebody has set for which processor Numba compiles."""
    features = config.CPU_FEATURES
    return config.CPU_NAME is not None or (features is not None and not features.endswith(_WIDE))
