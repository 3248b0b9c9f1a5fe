"""The errors that users meet: one base class, one subclass for each room.

Every message is a single line that names what was wrong, where (file, line or
key) and what was expected, so that the command line can print it as it is.
"""


class MobilityError(Exception):
    """Base of every error that bad input raises in this package."""


class ContentError(MobilityError):
    """What a file holds is not what its reader has declared."""


class CaptureError(MobilityError):
    """A recording or a manifest of recordings cannot be used."""


class MapError(MobilityError):
    """A mobility map cannot be built, read or written."""


class FloorPlanError(MobilityError):
    """A floor plan is unusable: geometry, exits, doors or room for people."""


class ModelError(MobilityError):
    """A model, a behaviour, a preset or one of their parameters is unknown or out of range."""


class ResultsError(MobilityError):
    """Results cannot be written, read or exported."""


class LiveError(MobilityError):
    """A message between a running model and a program that watches it cannot be used."""
