"""How fast people are at most, and how slim."""

from __future__ import annotations

FASTEST_SPRINT = 12.34
"""The fastest sprint ever measured, m/s (Graubner and Nixdorf, Biomechanical analysis of the sprint
and hurdles events at the 2009 IAAF World Championships in Athletics, New Studies in Athletics 26,
2011)."""

SLIMMEST_CORE = 0.02
"""The least radius of the disc that no other body enters, metres: nobody's is nearly as small."""
