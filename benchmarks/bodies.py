"""Bodies of a run: sliding feet, jumps at joins, and their joints in Blender beside ours.

    mesa-mobility run doorway --seed 1 --record decisions --out out/doorway
    python benchmarks/bodies.py out/doorway
    python3.11 -m venv out/blender && out/blender/bin/pip install bpy==4.2.0 'numpy<2'
    python benchmarks/bodies.py out/doorway --blender out/blender/bin/python

With --blender the run is written as glTF and as OpenUSD. Blender's own Python module imports each,
and the heads of its bones are compared with the joints at five times. bpy wants a Python of one
version, so it runs in a process of its own.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

TIMES = 5


def in_blender(path: str, frames: list[int], output: str) -> None:
    """Import a file and write the heads of all bones in some frames."""
    import bpy

    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.scene.render.fps = 30
    started = time.perf_counter()
    if path.endswith(".glb"):
        bpy.ops.import_scene.gltf(filepath=path)
    else:
        bpy.ops.wm.usd_import(filepath=path)
    took = time.perf_counter() - started
    found = []
    for frame in frames:
        bpy.context.scene.frame_set(frame)
        heads: dict[str, list[float]] = {}
        for each in bpy.context.scene.objects:
            if each.type == "ARMATURE":
                # Bones of glTF have the person's number in their names, those of USD's people not.
                person = "" if path.endswith(".glb") else _person(each) + "."
                for bone in each.pose.bones:
                    heads[person + bone.name] = list(each.matrix_world @ bone.head)
        found.append(heads)
    meshes = sum(each.type == "MESH" for each in bpy.context.scene.objects)
    answer = {"version": bpy.app.version_string, "seconds": took, "meshes": meshes, "heads": found}
    Path(output).write_text(json.dumps(answer), encoding="utf-8")
    os._exit(0)  # the module may crash when Python ends in the usual way


def _person(armature: object) -> str:
    """Number of the person whose skeleton this is, from the names of those above it."""
    above = armature
    while above is not None:
        name = above.name.partition(".")[0]
        if name.startswith("person_"):
            return name.removeprefix("person_")
        above = above.parent
    return "?"


def figures(run: Path) -> None:
    """Print how feet slide and joints turn, with feet held on the floor and without."""
    import numpy as np

    from mesa_mobility.bodies import PoseBank, body_motion, quality
    from mesa_mobility.bodies.rotations import angles
    from mesa_mobility.results.bodies import track_of
    from mesa_mobility.results.run import read_run

    trajectories = read_run(run).trajectories
    decisions = trajectories.decisions
    bank = PoseBank.of(decisions.maps[0])
    turns = bank.turns(np.arange(0, 2 * len(bank.rotations), 2))
    steps = angles(np.swapaxes(turns[:-1], -1, -2) @ turns[1:])
    recorded = np.delete(steps, bank.clips[1:-1] - 1, axis=0).max(axis=1)
    print(f"recordings: greatest turn of a joint in 1/30 s {_degrees(recorded)}")
    for planted in (False, True):
        found = []
        for person in np.unique(trajectories.person).tolist():
            frames, track = track_of(trajectories, person)
            movements = decisions.movements_of(person)
            found.append(quality(body_motion(bank, movements, frames, track, planted=planted)))
        slides, jumps = (
            np.concatenate([getattr(q, f) for q in found]) for f in ("slides", "jumps")
        )
        deep = np.concatenate([each.depths.ravel() for each in found])
        way = 100 * np.quantile(slides, [0.5, 0.9, 0.99])
        held = "held" if planted else "not held"
        print(
            f"feet {held}, {len(found)} people, {len(slides)} stances: slide {way[0]:.2f} cm "
            f"(90, 99 in 100: {way[1]:.1f}, {way[2]:.1f}); soles in the floor at most "
            f"{1000 * deep.max():.0f} mm; joints {_degrees(jumps)}"
        )


def _degrees(radians: object) -> str:
    import numpy as np

    values = np.rad2deg(np.quantile(np.asarray(radians), [0.5, 0.99, 0.999, 1.0]))
    return "median {:.1f}, 99 in 100 {:.1f}, 999 in 1000 {:.1f}, most {:.1f} degrees".format(
        *values
    )


def beside_blender(run: Path, python: Path, suffix: str) -> None:
    """Write one file, import it, and print how far joints are apart."""
    import numpy as np

    from mesa_mobility.animation import Selection, walkers, write_glb, write_usd
    from mesa_mobility.bodies.skeleton import JOINTS
    from mesa_mobility.results.run import read_run

    found = read_run(run)
    people = list(walkers(found.trajectories, Selection()))
    last = max(each.first + len(each.motion) for each in people) - 1
    frames = [round(last * share / TIMES) for share in range(TIMES)]
    with tempfile.TemporaryDirectory() as folder:
        path, output = Path(folder) / f"crowd{suffix}", Path(folder) / "heads.json"
        (write_glb if suffix == ".glb" else write_usd)(people, found.plan, path)
        words = [str(python), __file__, "--import", str(path), str(output), *map(str, frames)]
        subprocess.run(words, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        answer = json.loads(output.read_text(encoding="utf-8"))
        size = path.stat().st_size / 1e6
    apart, missing = [], 0
    for frame, heads in zip(frames, answer["heads"], strict=True):
        for each in people:
            if each.first <= frame < each.first + len(each.motion):
                ours = each.motion.positions[frame - each.first]
                for joint, place in zip(JOINTS, ours, strict=True):
                    head = heads.get(f"{each.person}.{joint}")
                    missing += head is None
                    if head is not None:
                        apart.append(float(np.linalg.norm(place - head)))
    most = max(apart, default=float("nan"))
    print(
        f"{suffix}: {len(people)} people, {last / 30:.1f} s, {size:.1f} MB; Blender "
        f"{answer['version']}: imported in {answer['seconds']:.1f} s, {answer['meshes']} meshes; "
        f"{len(apart)} joints at frames {frames}: {1000 * most:.3f} mm apart at most, "
        f"{missing} missing",
        flush=True,
    )


def main() -> None:
    """Read the command line and measure."""
    if sys.argv[1:2] == ["--import"]:
        path, output, *frames = sys.argv[2:]
        in_blender(path, [int(frame) for frame in frames], output)
        return
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("run", type=Path, help="folder of a run with its decisions")
    parser.add_argument("--blender", type=Path, help="a Python with bpy")
    chosen = parser.parse_args()
    if chosen.blender is None:
        figures(chosen.run)
        return
    for suffix in (".glb", ".usd"):
        beside_blender(chosen.run, chosen.blender, suffix)


if __name__ == "__main__":
    main()
