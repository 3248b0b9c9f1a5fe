"""The field's verification tests (RiMEA, IMO, NIST, ISO), as scenarios with verdicts."""

from mesa_mobility.verification.cases import Case, case, run_cases
from mesa_mobility.verification.catalogue import Entry, catalogue, suite
from mesa_mobility.verification.checks import Check, Verdict
from mesa_mobility.verification.suite import Outcome, VerificationTest, judged, verify

__all__ = [
    "Case",
    "Check",
    "Entry",
    "Outcome",
    "Verdict",
    "VerificationTest",
    "case",
    "catalogue",
    "judged",
    "run_cases",
    "suite",
    "verify",
]
