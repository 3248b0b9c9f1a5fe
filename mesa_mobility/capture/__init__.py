"""Recordings of people: readers, skeletons, resampling and mirroring."""

from mesa_mobility.capture.amc import read_amc
from mesa_mobility.capture.bvh import read_bvh
from mesa_mobility.capture.folder import find_clips, read_folder
from mesa_mobility.capture.jumps import find_jumps, sound_parts
from mesa_mobility.capture.legs import LegJoints, leg_joints
from mesa_mobility.capture.loading import LoadedClips, load_clips
from mesa_mobility.capture.manifest import Clip, Manifest, read_manifest
from mesa_mobility.capture.reading import read_recording
from mesa_mobility.capture.recording import Recording
from mesa_mobility.capture.skeleton import Skeleton
from mesa_mobility.capture.transforms import mirror, resample, scale, trim

__all__ = [
    "Clip",
    "LegJoints",
    "LoadedClips",
    "Manifest",
    "Recording",
    "Skeleton",
    "find_clips",
    "find_jumps",
    "leg_joints",
    "load_clips",
    "mirror",
    "read_amc",
    "read_bvh",
    "read_folder",
    "read_manifest",
    "read_recording",
    "resample",
    "scale",
    "sound_parts",
    "trim",
]
