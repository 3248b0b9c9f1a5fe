"""The version of the package that is installed."""

from __future__ import annotations

from importlib.metadata import PackageNotFoundError, version

from mesa_mobility.errors import MobilityError

try:
    __version__ = version("mesa-mobility")
except PackageNotFoundError:
    raise MobilityError(
        "mesa-mobility is not installed: expected `pip install .` in its folder, which also "
        "registers its models and behaviours"
    ) from None
