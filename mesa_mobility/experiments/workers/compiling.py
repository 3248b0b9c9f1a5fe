"""Compiling once for all workers that share a cache."""

from __future__ import annotations

from functools import lru_cache

from filelock import FileLock

from mesa_mobility.experiments.experiment import model_class


@lru_cache(maxsize=1)
def compile_once(model: type | str) -> None:
    """Compile what a run needs, unless it is in the cache; other processes wait and then read.

    Args:
        model: class or name; nothing is compiled for models without pedestrians.
    """
    from mesa_mobility.compiled.cache import folder
    from mesa_mobility.crowd import PedestrianModel

    place = folder()
    if place is None or not issubclass(model_class(model), PedestrianModel):
        return
    pattern = "*/decision.decide-*.nbc"
    if any(place.glob(pattern)):
        return
    from mesa_mobility.crowd.precompile import compile_decisions, compile_the_rest

    try:
        with FileLock(place / "compiling.lock"):
            if any(place.glob(pattern)):
                return
            compile_the_rest()
            # Last: its file says that all is there.
            compile_decisions()
    except OSError:  # a cache that cannot be written, or has no locks
        return
