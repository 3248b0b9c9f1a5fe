"""What the people of a map cannot do, measured before the map is used.

Lone people of the map walk through a door, round the corner of a corridor, turn round in a small
space, stop at a point, and walk slowly; a small crowd leaves by a door. All of it takes seconds and
gives the same figures each time. If it was measured how well a map of some clips predicts the
others, the examination judges that, too.
"""

from mesa_mobility.examination.examining import examine, examined, with_findings
from mesa_mobility.examination.finding import Finding

__all__ = ["Finding", "examine", "examined", "with_findings"]
