"""How well a map predicts people it has not seen: every seventh clip of each session is left out.

python benchmarks/maps/held_out_coverage.py manifest.tsv [--type able_bodied] [--clusters 200]
"""

from __future__ import annotations

import argparse
import json
from collections import defaultdict

from mesa_mobility.capture import load_clips, read_manifest
from mesa_mobility.mobility import build_map, coverage

EVERY = 7
MIRROR = "~mirror"


def main() -> None:
    """Build without the clips left out, and print one JSON object."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("manifest")
    parser.add_argument("--type", default="able_bodied")
    parser.add_argument("--clusters", type=int)
    given = parser.parse_args()
    recordings = load_clips(read_manifest(given.manifest), pedestrian_type=given.type).recordings
    sessions: dict[str, list[str]] = defaultdict(list)
    for recording in recordings:
        if not recording.name.endswith(MIRROR):
            sessions[recording.clip.session].append(recording.name)
    left_out = {name for names in sessions.values() for name in names[EVERY - 1 :: EVERY]}
    seen = [r for r in recordings if r.name.removesuffix(MIRROR) not in left_out]
    unseen = [r for r in recordings if r.name in left_out]
    result = coverage(build_map(seen, clusters=given.clusters), unseen)
    print(json.dumps({"clips_left_out": sorted(left_out), **result}))


if __name__ == "__main__":
    main()
