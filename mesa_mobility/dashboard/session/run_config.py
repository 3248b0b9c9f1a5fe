"""How a model is made, and making it in a thread that can be given up."""

from __future__ import annotations

import ctypes
import sys
import threading
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from solara.server import kernel_context

from mesa_mobility import PedestrianModel
from mesa_mobility.dashboard.session.notices import hear


@dataclass(frozen=True)
class Recipe:
    """How to make a model.

    Attributes:
        kind: its class.
        keywords: arguments of its constructor.
    """

    kind: type[PedestrianModel]
    keywords: Mapping[str, Any] = field(default_factory=dict)

    def make(self) -> PedestrianModel:
        """The model."""
        return self.kind(**self.keywords)


class GivenUp(BaseException):
    """Raised in a thread whose model is no longer wanted.

    Not an ``Exception``, which a model may catch.
    """


TRY_AGAIN_S = 0.05


def _raise_in(thread: threading.Thread) -> None:
    """Raise ``GivenUp`` in a thread as soon as it executes Python again."""
    if thread.is_alive() and thread.ident is not None:
        ctypes.pythonapi.PyThreadState_SetAsyncExc(
            ctypes.c_ulong(thread.ident), ctypes.py_object(GivenUp)
        )


_report_unraisable = sys.unraisablehook


def _raise_again(unraisable: sys.UnraisableHookArgs) -> None:
    """Raise ``GivenUp`` once more where a finalizer, which cannot pass it on, has got it."""
    if unraisable.exc_type is GivenUp:
        threading.Timer(TRY_AGAIN_S, _raise_in, [threading.current_thread()]).start()
    else:
        _report_unraisable(unraisable)


sys.unraisablehook = _raise_again


class Making:
    """A model that is made in a thread of its own.

    Args:
        recipe: how to make it.

    Attributes:
        done: set when the model is made, or has failed.
        notices: the warnings it has given.
    """

    def __init__(self, recipe: Recipe) -> None:
        self.done = threading.Event()
        self.notices: list[str] = []
        self._recipe = recipe
        self._model: PedestrianModel | None = None
        self._error: Exception | None = None
        # No thread starts in the context of a page that is just closing.
        with kernel_context.without_context():
            self._thread = threading.Thread(
                target=self._make, name="mesa-mobility make", daemon=True
            )
            self._thread.start()

    def _make(self) -> None:
        hear(self.notices.append)
        try:
            self._model = self._recipe.make()
        except GivenUp:
            return
        # A plug-in may fail in any way.
        except Exception as error:
            self._error = error
        self.done.set()

    def model(self) -> PedestrianModel:
        """The model, once ``done`` is set.

        Raises:
            Exception: whatever its constructor has raised.
        """
        if self._error is not None:
            raise self._error
        assert self._model is not None
        return self._model

    def give_up(self) -> None:
        """End the thread as soon as it executes Python again; callers need not wait."""
        _raise_in(self._thread)
