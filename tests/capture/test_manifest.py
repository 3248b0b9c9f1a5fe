import hashlib
import lzma

import numpy as np
import pytest

from mesa_mobility.capture import find_clips, load_clips, read_folder, read_manifest
from mesa_mobility.capture.manifest import COLUMNS
from mesa_mobility.errors import CaptureError


def row(name, data, **changes):
    values = {
        "file": name,
        "type": "able_bodied",
        "session": "one",
        "subject": "me",
        "clip": name.rsplit("/")[-1].split(".")[0],
        "description": "walk",
        "tags": "straight,slow",
        "native_fps": "30",
        "use_from": "1",
        "use_to": "50",
        "unit_to_m": "0.01",
        "licence": "CC0",
        "source_repo": "here",
        "source_commit": "abc",
        "source_path": "data/walk.bvh",
        "sha256": hashlib.sha256(data).hexdigest(),
    }
    return values | changes


@pytest.fixture
def manifest(write):
    """Write recordings and a manifest of them, from rows of :func:`row`."""

    def put(*rows, files=None, columns=COLUMNS, extra=""):
        for name, data in (files or {}).items():
            write(name, data)
        lines = ["\t".join(columns)]
        lines += ["\t".join(each[column] for column in columns) for each in rows]
        return write("manifest.tsv", "\n".join(lines) + "\n" + extra)

    return put


@pytest.fixture
def walk(walker_bvh):
    return walker_bvh(50).encode()


def test_a_manifest_says_what_its_columns_say(manifest, walk):
    path = manifest(row("walks/a.bvh", walk), files={"walks/a.bvh": walk}, extra="\n\n")
    (clip,) = read_manifest(path)
    assert clip.file == "walks/a.bvh"
    assert clip.path == path.parent / "walks" / "a.bvh"
    assert clip.tags == ("straight", "slow")
    assert (clip.native_fps, clip.use_from, clip.use_to, clip.unit_to_m) == (30.0, 1, 50, 0.01)
    assert (clip.licence, clip.source_repo, clip.source_commit) == ("CC0", "here", "abc")
    assert clip.where == f"{path}, line 2"


def test_columns_may_come_in_any_order_with_others_between(manifest, walk):
    columns = ("mood", *reversed(COLUMNS))
    path = manifest(row("a.bvh", walk, mood="merry"), files={"a.bvh": walk}, columns=columns)
    assert read_manifest(path).clips[0].clip == "a"


def test_clips_come_cut_resampled_and_followed_by_their_mirror_images(manifest, walker_bvh):
    fast = walker_bvh(201, "0.0083333").encode()
    path = manifest(
        row("b.bvh", fast, native_fps="120", use_from="1", use_to="201"),
        row("a.bvh", fast, native_fps="120", use_from="5", use_to="190", clip="early"),
        files={"a.bvh": fast, "b.bvh": fast},
    )
    loaded = load_clips(read_manifest(path))
    assert [r.name for r in loaded.recordings] == ["b", "b~mirror", "early", "early~mirror"]
    # 200 frames, every fourth of them: 50.  185 frames: 47.
    assert [r.frames for r in loaded.recordings] == [50, 50, 47, 47]
    assert {r.frame_rate for r in loaded.recordings} == {30.0}
    # The walker moves 1 cm a frame: the first frame used is frame 5, then 9.
    np.testing.assert_allclose(loaded.recordings[2].root_position[:2, 0], [0.05, 0.09])
    assert all(r.clip.licence == "CC0" for r in loaded.recordings)
    assert loaded.skipped == []
    plain = load_clips(read_manifest(path), mirrored=False)
    assert [r.name for r in plain.recordings] == ["b", "early"]


def test_short_clips_are_skipped_and_said(manifest, walk):
    path = manifest(
        row("a.bvh", walk, use_from="0", use_to="44"),
        row("b.bvh", walk, use_from="0", use_to="45"),
        files={"a.bvh": walk, "b.bvh": walk},
    )
    loaded = load_clips(read_manifest(path), mirrored=False)
    assert [r.name for r in loaded.recordings] == ["b"]
    assert loaded.skipped == [("a", "44 frames at 30 Hz, 45 needed")]
    short = load_clips(read_manifest(path), mirrored=False, minimum_frames=44)
    assert [r.name for r in short.recordings] == ["a", "b"]


def test_only_clips_of_the_type_are_read(manifest, walk):
    path = manifest(
        row("a.bvh", walk),
        row("b.bvh", b"unread", type="running", sha256="0"),
        files={"a.bvh": walk, "b.bvh": b"other"},
    )
    loaded = load_clips(read_manifest(path), pedestrian_type="able_bodied")
    assert [r.name for r in loaded.recordings] == ["a", "a~mirror"]
    with pytest.raises(CaptureError, match=r"no clips of type 'old', .* able_bodied, running"):
        load_clips(read_manifest(path), pedestrian_type="old")


def test_progress_counts_the_clips(manifest, walk):
    path = manifest(row("a.bvh", walk), row("b.bvh", walk), files={"a.bvh": walk, "b.bvh": walk})
    seen = []
    load_clips(read_manifest(path), progress=lambda done, total: seen.append((done, total)))
    assert seen == [(1, 2), (2, 2)]


def test_the_sha256_of_a_compressed_recording_is_that_of_its_content(manifest, walk):
    packed = {"a.bvh.xz": lzma.compress(walk)}
    loaded = load_clips(read_manifest(manifest(row("a.bvh.xz", walk), files=packed)))
    assert loaded.recordings[0].frames == 49


def test_another_sha256_is_refused_with_what_was_found_and_expected(manifest, walk):
    wrong = "0" * 64
    path = manifest(row("a.bvh", walk, sha256=wrong), files={"a.bvh": walk})
    found = hashlib.sha256(walk).hexdigest()
    with pytest.raises(CaptureError) as error:
        load_clips(read_manifest(path))
    assert str(error.value) == f"{path}, line 2: a.bvh has sha256 {found}, expected {wrong}"


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"file": "gone.bvh"}, "line 2: no file 'gone.bvh' beside the manifest"),
        ({"file": ""}, "line 2: column file is empty"),
        ({"clip": ""}, "line 2: column clip is empty"),
        ({"sha256": " "}, "line 2: column sha256 is empty"),
        ({"native_fps": "0"}, "line 2: native_fps 0, expected 12 to 100000 Hz"),
        ({"native_fps": "fast"}, "line 2, native_fps: 'fast', expected a finite number"),
        ({"unit_to_m": "-1"}, "line 2, unit_to_m: unit of -1.0 m, expected a positive length"),
        ({"unit_to_m": "nan"}, "line 2, unit_to_m: 'nan', expected a finite number"),
        ({"use_from": "1.5"}, "line 2, use_from: '1.5', expected a whole number"),
        ({"use_from": "-1"}, "line 2: frames -1:50, expected 0 <= use_from < use_to"),
        ({"use_from": "50"}, "line 2: frames 50:50, expected 0 <= use_from < use_to"),
        ({"licence": "a\tb"}, "line 2: 17 columns, expected 16"),
    ],
)
def test_bad_rows_are_named_with_the_line_and_the_column(manifest, walk, changes, message):
    path = manifest(row("a.bvh", walk, **changes), files={"a.bvh": walk})
    with pytest.raises(CaptureError) as error:
        read_manifest(path)
    assert str(error.value) == f"{path}, {message}"


def test_a_file_may_be_listed_once(manifest, walk):
    path = manifest(row("a.bvh", walk), row("a.bvh", walk), files={"a.bvh": walk})
    with pytest.raises(CaptureError, match=r"line 3: file 'a\.bvh' is on line 2 too"):
        read_manifest(path)


@pytest.mark.parametrize("column", COLUMNS)
def test_every_column_is_needed(manifest, walk, column):
    columns = [name for name in COLUMNS if name != column]
    path = manifest(row("a.bvh", walk), files={"a.bvh": walk}, columns=columns)
    with pytest.raises(CaptureError, match=f"line 1: no column '{column}', expected file, type"):
        read_manifest(path)


def test_a_manifest_without_clips_is_refused(manifest):
    with pytest.raises(CaptureError, match="no clips"):
        read_manifest(manifest())


@pytest.mark.parametrize(
    ("content", "message"), [(b"", "empty file"), (b"PK\3\4\0\0", "line 1: zero byte")]
)
def test_what_is_no_manifest_is_refused(write, content, message):
    with pytest.raises(CaptureError, match=message):
        read_manifest(write("manifest.tsv", content))


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"use_to": "51"}, r"line 2: use_to 51, but a\.bvh has 50 frames"),
        ({"native_fps": "120"}, r"line 2: native_fps 120, but a\.bvh has 30 frames a second"),
    ],
)
def test_rows_that_contradict_their_file_are_refused(manifest, walk, changes, message):
    path = manifest(row("a.bvh", walk, **changes), files={"a.bvh": walk})
    with pytest.raises(CaptureError, match=message):
        load_clips(read_manifest(path))


def test_a_unit_that_makes_legs_of_no_human_is_refused(manifest, walk):
    # Legs of 45 + 40 units: 2.55 m in units of 3 cm.
    path = manifest(row("a.bvh", walk, unit_to_m="0.03"), files={"a.bvh": walk})
    with pytest.raises(CaptureError) as error:
        load_clips(read_manifest(path))
    assert str(error.value) == (
        f"{path}, line 2: a.bvh has legs of 2.55 m with unit_to_m 0.03, expected 0.25 to 1.3 m"
    )


def test_feet_of_no_human_are_refused(manifest, walk):
    # A toe 120 units ahead of the ankle, and 80 below: 1.44 m.
    long = walk.replace(b"OFFSET 0 -8 12", b"OFFSET 0 -80 120")
    path = manifest(row("a.bvh", long), files={"a.bvh": long})
    with pytest.raises(CaptureError, match=r"a\.bvh has hips or feet 1\.44 m long, expected at"):
        load_clips(read_manifest(path))


def test_a_recording_without_legs_is_named(manifest, walk):
    legless = walk.replace(b"UpLeg", b"Wing")
    path = manifest(row("a.bvh", legless), files={"a.bvh": legless})
    with pytest.raises(CaptureError, match=r"line 2: a\.bvh: no legs: found LeftLeg, LeftFoot"):
        load_clips(read_manifest(path))


@pytest.mark.parametrize("unit", [1.0, 0.01, 0.0254, 0.0564444, 0.001])
def test_without_a_manifest_the_unit_is_the_one_that_makes_legs_plausible(write, walker_bvh, unit):
    # The walker's legs are 0.85 m long; written in the unit, they are 0.85 / unit.
    text = walker_bvh(50)
    for length in ("-45", "-40"):
        text = text.replace(f"0 {length} 0", f"0 {float(length) / 100 / unit!r} 0")
    path = write("walk.bvh", text)
    (clip,) = read_folder(path.parent)
    assert clip.unit_to_m == unit
    assert (clip.clip, clip.use_from, clip.use_to, clip.native_fps) == ("walk", 0, 50, 30.0)


def test_a_folder_gives_its_recordings_by_name(write, walk):
    for name in ("d.bvh", "a.bvh.xz", "c.BVH", "f.bvh", "b.bvh", "e.bvh"):
        write(name, lzma.compress(walk) if name.endswith("xz") else walk)
    folder = write("readme.txt", "not a recording").parent
    manifest = read_folder(folder)
    assert [clip.clip for clip in manifest] == ["a", "b", "c", "d", "e", "f"]
    # The type of such clips is not known: they go with any.
    loaded = load_clips(manifest, pedestrian_type="able_bodied", mirrored=False)
    assert [r.frames for r in loaded.recordings] == [50] * 6


def test_a_folder_without_recordings_and_legs_of_no_plausible_length_are_refused(write, walk):
    folder = write("readme.txt", "not a recording").parent
    with pytest.raises(CaptureError, match=r"no recordings, expected .* \.amc$"):
        read_folder(folder)
    write("more/deep/b.bvh", walk)
    write("more/a.bvh", walk)
    with pytest.raises(CaptureError, match=r"some below it in more, more/deep: give one of these"):
        read_folder(folder)
    write("giant.bvh", walk.replace(b" -45 ", b" -450 "))
    with pytest.raises(CaptureError, match=r"giant\.bvh: legs 490 units long, expected 0\.6 to"):
        read_folder(folder)
    write("giant.bvh", walk.replace(b"UpLeg", b"Wing"))
    with pytest.raises(CaptureError, match=r"giant\.bvh: no legs: found LeftLeg, LeftFoot"):
        read_folder(folder)
    with pytest.raises(CaptureError, match="nowhere: cannot be read"):
        read_folder(folder / "nowhere")


def test_clips_are_found_in_a_manifest_a_folder_and_a_single_recording(manifest, write, walk):
    alone = write("alone/walk.bvh", walk)
    assert [clip.path for clip in find_clips(alone)] == [alone]
    assert [clip.path for clip in find_clips(alone.parent)] == [alone]
    path = manifest(row("alone/walk.bvh", walk, clip="listed"))
    assert [clip.clip for clip in find_clips(path)] == ["listed"]
    assert [clip.clip for clip in find_clips(path.parent)] == ["listed"]
    with pytest.raises(CaptureError, match="cannot be read"):
        find_clips(path.with_name("nowhere"))
