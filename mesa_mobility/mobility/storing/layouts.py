"""The arrays of the two kinds of map files, with their types."""

OPTIONS = {
    "offsets": "int64",
    "durations": "int16",
    "costs": "uint16",
    "end_points": "int16",
    "end_headings": "int16",
    "end_clusters": "uint16",
    "path_steps": "int16",
    "path_clusters": "uint16",
    "mean_poses": "float32",
    "centres": "float32",
    "sizes": "int64",
    "mean_speeds": "float32",
    "metadata": "uint8",
}
"""All options, with their paths."""

FAMILIES = {
    "counts": "int32",
    "costs": "uint16",
    "sources": "uint16",
    "jump_frames": "uint8",
    "jump_poses": "uint16",
    "steps": "int16",
    "labels": "uint16",
    "mean_poses": "float32",
    "centres": "float32",
    "sizes": "int64",
    "mean_speeds": "float64",
    "metadata": "uint8",
}
"""Recorded options as ways through the poses; see ``families``."""
