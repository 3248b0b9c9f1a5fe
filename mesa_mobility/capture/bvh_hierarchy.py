"""The HIERARCHY of a BVH file: joints, offsets and channels."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field

from mesa_mobility.capture.skeleton import END, check_joints
from mesa_mobility.capture.text import numbers, quote, whole_number
from mesa_mobility.errors import CaptureError

CHANNELS = {
    f"{axis}{kind}".lower(): (axis, kind) for axis in "XYZ" for kind in ("position", "rotation")
}


@dataclass
class BvhJoint:
    """A joint as the file has it.

    Attributes:
        name: name in the file; the free end of a leaf is called after its joint.
        parent: index of the parent joint, -1 for the root.
        line: line of the file where the joint begins.
        offset: three numbers in file units.
        channels: (axis, kind) in the order of the motion's columns; kind is "position" or
            "rotation".
        opened: whether its brace has been opened.
        is_end: whether it is the free end of a leaf.
    """

    name: str
    parent: int
    line: int
    offset: list[float] | None = None
    channels: list[tuple[str, str]] | None = None
    opened: bool = False
    is_end: bool = False


@dataclass
class _Builder:
    where: str
    joints: list[BvhJoint] = field(default_factory=list)
    open_joints: list[int] = field(default_factory=list)
    names: set[str] = field(default_factory=set)

    def at(self, line: int) -> str:
        return f"{self.where}, line {line}"

    def begin(self, keyword: str, name: str, line: int) -> None:
        at = self.at(line)
        if keyword == "ROOT" and self.joints:
            raise CaptureError(f"{at}: a second ROOT, expected one skeleton in the file")
        if keyword != "ROOT" and not self.open_joints:
            raise CaptureError(f"{at}: {keyword} outside of a joint, expected ROOT first")
        parent = self.open_joints[-1] if self.open_joints else -1
        if parent >= 0:
            self._require_complete(self.joints[parent], at)
            if self.joints[parent].is_end:
                raise CaptureError(f"{at}: {keyword} inside of an End Site, expected '}}'")
        is_end = keyword == "END"
        if is_end:
            name = self._end_name(self.joints[parent].name)
        elif not name:
            raise CaptureError(f"{at}: {keyword} without a name")
        if name in self.names:
            raise CaptureError(f"{at}: joint {quote(name)} occurs twice, expected distinct names")
        self.names.add(name)
        check_joints(len(self.names), at)
        self.open_joints.append(len(self.joints))
        joint = BvhJoint(name, parent, line, is_end=is_end)
        if is_end:
            joint.channels = []
        self.joints.append(joint)

    def _end_name(self, parent: str) -> str:
        name, count = parent + END, 1
        while name in self.names:
            count += 1
            name = f"{parent}{END}{count}"
        return name

    def current(self, keyword: str, line: int) -> BvhJoint:
        if not self.open_joints or not self.joints[self.open_joints[-1]].opened:
            raise CaptureError(f"{self.at(line)}: {keyword} outside of a joint's braces")
        return self.joints[self.open_joints[-1]]

    def open(self, line: int) -> None:
        if not self.open_joints or self.joints[self.open_joints[-1]].opened:
            raise CaptureError(
                f"{self.at(line)}: unexpected '{{', expected it after a joint's name"
            )
        self.joints[self.open_joints[-1]].opened = True

    def close(self, line: int) -> None:
        joint = self.current("'}'", line)
        self._require_complete(joint, self.at(line))
        self.open_joints.pop()

    def _require_complete(self, joint: BvhJoint, at: str) -> None:
        if not joint.opened:
            raise CaptureError(f"{at}: joint {quote(joint.name)} has no '{{' after its name")
        if joint.offset is None:
            raise CaptureError(f"{at}: joint {quote(joint.name)} has no OFFSET before this line")
        if joint.channels is None:
            raise CaptureError(f"{at}: joint {quote(joint.name)} has no CHANNELS before this line")

    def offset(self, rest: str, line: int) -> None:
        joint = self.current("OFFSET", line)
        if joint.offset is not None:
            raise CaptureError(f"{self.at(line)}: a second OFFSET of joint {quote(joint.name)}")
        joint.offset = numbers(rest.split(), 3, f"{self.at(line)}, OFFSET")

    def channels(self, rest: str, line: int) -> None:
        at = self.at(line)
        joint = self.current("CHANNELS", line)
        if joint.channels is not None:
            raise CaptureError(f"{at}: unexpected CHANNELS of {quote(joint.name)}")
        count, *names = rest.split() or [""]
        declared = whole_number(count, f"{at}, CHANNELS")
        if declared != len(names):
            raise CaptureError(f"{at}: CHANNELS {declared}, but {len(names)} are named")
        joint.channels = []
        for name in names:
            channel = CHANNELS.get(name.lower())
            if channel is None:
                raise CaptureError(
                    f"{at}: channel {quote(name)}, expected Xposition, Yrotation and the like"
                )
            if channel in joint.channels:
                raise CaptureError(f"{at}: channel {name} occurs twice in one joint")
            joint.channels.append(channel)


def pieces(lines: Iterator[tuple[int, str]]) -> Iterator[tuple[int, str]]:
    """Lines cut at braces, which some programs write behind a joint's name."""
    for line, text in lines:
        for piece in re.split(r"([{}])", text):
            if piece := piece.strip():
                yield line, piece


def read_hierarchy(lines: Iterator[tuple[int, str]], where: str) -> list[BvhJoint]:
    """Joints of a BVH file, parents first, up to and including the line ``MOTION``.

    Args:
        lines: (line number, text) of the file from its beginning; left behind ``MOTION``.
        where: name of the file, for errors.

    Raises:
        CaptureError: the hierarchy is broken or ends too soon.
    """
    build = _Builder(where)
    started, last = False, 0
    for line, piece in pieces(lines):
        last = line
        keyword, _, rest = piece.replace("\t", " ").partition(" ")
        keyword, rest = keyword.upper(), rest.strip()
        if not started:
            if keyword != "HIERARCHY":
                raise CaptureError(f"{build.at(line)}: {quote(piece)}, expected HIERARCHY")
            started = True
        elif keyword in ("ROOT", "JOINT", "END"):
            build.begin(keyword, rest, line)
        elif keyword == "{":
            build.open(line)
        elif keyword == "}":
            build.close(line)
        elif keyword == "OFFSET":
            build.offset(rest, line)
        elif keyword == "CHANNELS":
            build.channels(rest, line)
        elif keyword == "MOTION":
            if build.open_joints:
                name = build.joints[build.open_joints[-1]].name
                raise CaptureError(f"{build.at(line)}: MOTION inside of joint {quote(name)}")
            if not build.joints:
                raise CaptureError(f"{build.at(line)}: MOTION before ROOT")
            return build.joints
        else:
            raise CaptureError(
                f"{build.at(line)}: {quote(piece)}, expected a joint, OFFSET, CHANNELS or MOTION"
            )
    raise CaptureError(f"{where}: ends at line {last} without MOTION (truncated?)")
