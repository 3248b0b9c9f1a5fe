"""Compiling once for all workers that share a cache."""

from __future__ import annotations

from functools import lru_cache

from filelock import FileLock

from mesa_mobility.experiments.experiment import model_class


@lru_cache(maxsize=1)
def compile_once(model: type | str) -> None:
    """Compile what a run needs, unless it is in the cache; other processes wait and then read.

    Args:
        model: class or name; nothing is compiled for models that neither are nor make models with
            pedestrians.
    """
    from mesa_mobility.compiled.cache import compile_natively, folder
    from mesa_mobility.crowd import PedestrianModel
    from mesa_mobility.crowd.precompile import LOCK

    kind = model_class(model)
    if not (issubclass(kind, PedestrianModel) or getattr(kind, "makes_models", False)):
        return
    place = folder()
    if place is None:  # before the first run, whose time may be limited
        _compile()
        return
    # A campaign takes long enough to be worth code for this very processor.
    compile_natively()
    if is_compiled():
        return
    try:
        with FileLock(place / LOCK):
            if not is_compiled():
                _compile()
    except (OSError, NotImplementedError):  # a cache that cannot be written, or has no locks
        _compile()


def is_compiled() -> bool:
    """Whether the cache has what a run needs, compiled on this machine."""
    from mesa_mobility.compiled.cache import folder

    place = folder()
    return place is not None and any(place.glob("*/decision.decide-*.nbc"))


def _compile() -> None:
    from mesa_mobility.crowd.precompile import compile_decisions, compile_the_rest

    compile_the_rest()
    # Last: its file says that all is there.
    compile_decisions()
