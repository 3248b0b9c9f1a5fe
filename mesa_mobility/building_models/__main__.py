"""Prints what a building model holds: ``python -m mesa_mobility.building_models FILE BYTES``.

It prints JSON, and BYTES limit the memory. IfcOpenShell is compiled code, which a damaged file may
crash, or keep busy. So the reader of floor plans starts this in a process of its own. It imports
hardly anything else of the package, so that it starts at once.
"""

import json
import os
import sys

from mesa_mobility._memory import limit_memory
from mesa_mobility.building_models.extraction import all_of

if __name__ == "__main__":
    # Compiled code may print whatever it likes.
    answer = os.fdopen(os.dup(1), "w")
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    limit_memory(int(sys.argv[2]))
    try:
        result = all_of(sys.argv[1], "furniture" in sys.argv[3:])
    except Exception as error:  # a damaged file leads IfcOpenShell into errors of any kind
        reason = " ".join(str(error).split())[:120] or type(error).__name__
        result = {"error": reason}
    with answer:
        json.dump(result, answer)
