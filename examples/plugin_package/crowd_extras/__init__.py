"""Plug-ins for mesa-mobility: people in a clinic who keep away from the infected."""

from crowd_extras.models import Clinic
from crowd_extras.people import Patient
from crowd_extras.target_choice import SeeTheDoctor
from crowd_extras.terms import KeepAway, KeepLeft

__all__ = ["Clinic", "KeepAway", "KeepLeft", "Patient", "SeeTheDoctor"]
