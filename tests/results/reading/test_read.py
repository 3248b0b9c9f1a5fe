"""Reading of tracks: formats, units, and what is said of files that are not as they should be."""

import re
import sqlite3
import warnings

import numpy as np
import pedpy
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mesa_mobility import Trajectories
from mesa_mobility.errors import ResultsError
from mesa_mobility.results import write_juelich_text, write_jupedsim_sqlite
from mesa_mobility.results.reading.rates import gait_rates
from mesa_mobility.results.reading.rows import BAD_ROW, DUPLICATE, GAP, JUMP, Rows

HEADER = "# framerate: 16 fps\n# id frame x/cm y/cm z/cm\n"


def two_walkers(unit: float = 100.0, frames: int = 40) -> list[tuple[int, int, float, float]]:
    """Rows of two people 0.8 m apart who walk along +x at 1.6 m/s, 0.1 m a frame of 16 Hz."""
    return [
        (person, frame, unit * 0.1 * frame, unit * 0.8 * person)
        for person in (1, 2)
        for frame in range(frames)
    ]


def text(rows, header: str = "") -> str:
    return header + "".join(f"{p} {f} {x:.6g} {y:.6g} 170\n" for p, f, x, y in rows)


def quiet(path, **keywords) -> Trajectories:
    """Tracks of a file; a warning is an error."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        return Trajectories.read(path, **keywords)


@pytest.fixture
def file(tmp_path):
    def make(content: str, name: str = "run.txt"):
        path = tmp_path / name
        path.write_text(content, encoding="utf-8")
        return path

    return make


def test_text_is_read_as_pedpy_reads_it(file):
    path = file(text(two_walkers(), HEADER))
    tracks, theirs = quiet(path), pedpy.load_trajectory(trajectory_file=path)
    own = tracks.to_pandas().rename(columns={"person": "id"})
    own = own.sort_values(["id", "frame"]).reset_index()
    assert tracks.frame_rate == theirs.frame_rate == 16
    for column in ("id", "frame", "x", "y"):
        np.testing.assert_allclose(own[column], theirs.data[column], atol=1e-12)
    assert (tracks.reading.unit, tracks.reading.unit_from) == ("cm", "file")


@pytest.mark.parametrize(("unit", "per_metre"), [("m", 1), ("cm", 100), ("mm", 1000)])
def test_units_are_guessed_and_said(file, unit, per_metre):
    path = file(text(two_walkers(per_metre)))
    said = re.escape(f"{path}: taken to be in {unit}: nearest people are then 0.8 m apart and walk")
    with pytest.warns(UserWarning, match=said):
        tracks = Trajectories.read(path, frame_rate=16)
    assert tracks.reading.unit == unit
    assert tracks.x.max() == pytest.approx(3.9)
    assert tracks.y.max() == pytest.approx(1.6)


@given(
    spacing=st.floats(0.35, 4.0),
    speed=st.floats(0.1, 2.0),
    unit=st.sampled_from([("m", 1.0), ("cm", 0.01)]),
)
def test_units_of_crowds_from_jams_to_halls_are_found(tmp_path_factory, spacing, speed, unit):
    path = tmp_path_factory.mktemp("units") / "run.txt"
    rows = [
        (p, f, speed * f / 16 / unit[1], spacing * p / unit[1]) for p in range(4) for f in range(32)
    ]
    path.write_text(text(rows))
    with pytest.warns(UserWarning, match="taken to be in"):
        assert Trajectories.read(path, frame_rate=16).reading.unit == unit[0]


def test_given_units_and_rates_need_no_guess(file):
    tracks = quiet(file(text(two_walkers())), unit="cm", frame_rate=16)
    assert tracks.x.max() == pytest.approx(3.9)
    assert (tracks.reading.unit_from, tracks.reading.frame_rate_from) == ("argument", "argument")


@pytest.mark.parametrize(
    ("content", "keywords", "said"),
    [
        (text(two_walkers()), {}, "no frame rate in it: give it, as in frame_rate=16"),
        (text(two_walkers(), HEADER), {"unit": "m"}, "header says cm, but unit='m' was given"),
        (text(two_walkers(), HEADER), {"frame_rate": 25}, "16 frames a second, but frame_rate=25"),
        (
            text(two_walkers()),
            {"unit": "m", "frame_rate": 16},
            "not in m: person 1 goes 160 m/s in the second from frame 0; unit='cm' would fit",
        ),
        (
            text(two_walkers(1)),
            {"unit": "cm", "frame_rate": 16},
            "not in cm: heads are 0.008 m apart (person 1, frame 0); unit='m' would fit",
        ),
        (text(two_walkers()), {"unit": "inch", "frame_rate": 16}, "unit 'inch': expected one of"),
        (text(two_walkers()), {"frame_rate": 0}, "frame_rate is 0, expected a positive number"),
        ("", {}, "no rows, expected id, frame, x, y"),
        ("id;frame\n1;2\n", {}, "line 1: 'id;frame', expected id, frame, x, y"),
        (text([(-1, 0, 0, 0)], HEADER), {}, "person -1, frame 0: person is -1, expected 0 to"),
        (text([(1, 10**9, 0, 0)], HEADER), {}, "frame is 1000000000, expected 0 to"),
        (text([(1, 0, 5, 5)] * 2), {"frame_rate": 16}, "nobody moves or is near others"),
    ],
)
def test_what_cannot_be_used_is_refused_in_one_line(file, content, keywords, said):
    path = file(content)
    with pytest.raises(ResultsError, match=re.escape(said)) as caught:
        Trajectories.read(path, **keywords)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("name", "said"), [("none.txt", "no such file"), ("run.xyz", "whose name ends in .txt")]
)
def test_unknown_files_are_refused(file, tmp_path, name, said):
    file("", "run.xyz")
    with pytest.raises(ResultsError, match=re.escape(said)):
        Trajectories.read(tmp_path / name)


def test_faults_are_named_with_file_person_and_frame(file):
    rows = two_walkers()
    rows = [row for row in rows if row[:2] not in {(1, 10), (1, 11)}]
    # From frame 20 on, person 2 is 1 m to the side.
    rows = [(p, f, x, y + 100 * (p == 2 and f >= 20)) for p, f, x, y in rows]
    rows.insert(5, rows[4])
    path = file(text(rows, HEADER) + "1 17 a 3\n")
    with pytest.warns(UserWarning, match=re.escape(str(path))) as caught:
        tracks = Trajectories.read(path)
    assert [str(each.message) for each in caught] == [
        f"{path}: line {len(rows) + 3}: '1 17 a 3', expected id, frame, x, y",
        f"{path}: person 1 is twice in frame 4: the first row counts",
        f"{path}: person 1 is missing from frame 10 to 11",
        f"{path}: person 2 jumps by 1.00 m from frame 19 to 20",
    ]
    assert caught[0].filename == __file__
    faults = [(each.kind, each.person, each.frame) for each in tracks.reading.faults]
    assert faults == [(BAD_ROW, None, None), (DUPLICATE, 1, 4), (GAP, 1, 9), (JUMP, 2, 19)]
    assert len(tracks) == 78


def test_several_faults_of_a_kind_share_a_line(file):
    rows = [row for row in two_walkers() if row[1] not in {10, 20, 30}]
    with pytest.warns(UserWarning, match=r"person 1 is missing .* \(and 5 more\)$") as caught:
        tracks = Trajectories.read(file(text(rows, HEADER)))
    assert len(caught) == 1
    assert len(tracks.reading.of_kind(GAP)) == 6


def test_outliers_are_jumps_there_and_back(file):
    rows = [(p, f, x, y + 40 * (p == 1 and f == 7)) for p, f, x, y in two_walkers()]
    with pytest.warns(UserWarning, match="jumps by"):
        tracks = Trajectories.read(file(text(rows, HEADER)))
    assert [each.frame for each in tracks.reading.of_kind(JUMP)] == [6, 7]


def test_one_person_alone_is_said(file):
    with pytest.warns(UserWarning, match="person 1 is the only one, in frames 0 to 39"):
        Trajectories.read(file(text(two_walkers()[:40], HEADER)))


def test_every_tenth_frame_is_no_gap(file):
    rows = [(p, 10 * f, x, y) for p, f, x, y in two_walkers(frames=12)]
    assert quiet(file(text(rows, "# framerate: 160\n# x/cm\n"))).reading.faults == ()


def test_headings_are_the_way_that_people_came(file):
    # Along +x for 2 s, then 2 s of standing, then along +y.
    place = [(0.1 * min(f, 32), 0.1 * max(f - 64, 0)) for f in range(96)]
    rows = [(p, f, x, y + p) for p in (1, 2) for f, (x, y) in enumerate(place)]
    tracks = quiet(file(text(rows, "# framerate: 16\n# x/m\n")))
    heading = tracks.heading[tracks.person == 1]
    np.testing.assert_allclose(heading[:64], 0.0, atol=1e-12)
    # 0.8 s are 13 frames: from frame 64 + 13 on, all of the window is along +y.
    np.testing.assert_allclose(heading[77:], np.pi / 2)


def test_own_formats_come_back(file, tmp_path, two_leave_one_stays, room):
    own = two_leave_one_stays
    own.to_parquet(tmp_path / "run.parquet")
    write_juelich_text(own, tmp_path / "run2.txt")
    write_jupedsim_sqlite(own, tmp_path / "run.sqlite", room.free)
    parquet = quiet(tmp_path / "run.parquet", unit="m", frame_rate=2)
    np.testing.assert_array_equal(parquet.x, own.x)
    assert parquet.remaining.tolist() == own.remaining.tolist()
    assert parquet.reading.unit_from == "file"
    database, written = (quiet(tmp_path / name) for name in ("run.sqlite", "run2.txt"))
    # Those two formats have the rows of people who walk on beyond the exit.
    np.testing.assert_allclose(database.x, written.x, atol=1e-4)
    np.testing.assert_allclose(database.heading, 0.0)
    assert database.people == own.people
    with pytest.raises(ResultsError, match="it is in m, but unit='cm' was given"):
        Trajectories.read(tmp_path / "run.parquet", unit="cm")
    with pytest.raises(ResultsError, match="it has 2 frames a second, but frame_rate=3 was given"):
        Trajectories.read(tmp_path / "run.parquet", frame_rate=3)


def test_damaged_databases_are_refused(tmp_path):
    path = tmp_path / "run.sqlite"
    path.write_bytes(b"no database at all, whatever its name says")
    with pytest.raises(ResultsError, match="not a readable JuPedSim database"):
        Trajectories.read(path)
    path.unlink()
    database = sqlite3.connect(path)
    with database:
        database.execute("CREATE TABLE trajectory_data (frame, id, pos_x, pos_y)")
    database.close()
    with pytest.raises(ResultsError, match="no such column: ori_x"):
        Trajectories.read(path)


def test_the_archives_hdf5_is_read(tmp_path):
    h5py = pytest.importorskip("h5py")
    rows = np.array(two_walkers(1), dtype=[("id", "i8"), ("frame", "i8"), ("x", "f8"), ("y", "f8")])
    path = tmp_path / "run.h5"
    with h5py.File(path, "w") as target:
        target["trajectory"] = rows
        target["trajectory"].attrs["fps"] = 16.0
    with pytest.warns(UserWarning, match="taken to be in m"):
        tracks = Trajectories.read(path)
    assert (len(tracks), tracks.frame_rate) == (80, 16)
    assert tracks.x.max() == pytest.approx(3.9)
    with h5py.File(path, "w"):
        pass
    with pytest.raises(ResultsError, match=r"PedPy cannot read it: .*'trajectory' dataset"):
        Trajectories.read(path)


@pytest.mark.parametrize("reader", ["pathfinder_csv", "viswalk"])
def test_files_of_other_simulators_are_read_through_pedpy(file, reader):
    if not hasattr(pedpy, f"load_trajectory_from_{reader}"):
        pytest.skip(f"PedPy {pedpy.__version__} has no reader of {reader} files")
    head, mark = {
        "pathfinder_csv": ("id,t,x,y\n", ","),
        "viswalk": ("$VISION\n$PEDESTRIAN:NO;SIMSEC;COORDCENTX;COORDCENTY\n", ";"),
    }[reader]
    rows = [mark.join(map(str, (p, f / 16, x, y))) for p, f, x, y in two_walkers(1)]
    tracks = quiet(file(head + "\n".join(rows) + "\n", "run.csv"))
    assert (tracks.people, len(tracks), tracks.frame_rate) == (2, 80, 16)
    assert tracks.x.max() == pytest.approx(3.9)


def test_files_that_no_reader_knows_are_refused(file):
    with pytest.raises(ResultsError, match="PedPy cannot read it"):
        Trajectories.read(file("a,b\n1,2\n", "run.csv"))


def swaying(rate: float, person: int, speed: float, seconds: float = 20.0):
    """Rows of somebody whose step is 0.38 times their steps a second, and whose head sways."""
    steps = np.sqrt(speed / 0.38)
    frames = np.arange(round(seconds * rate))
    x = speed * frames / rate
    y = 1.2 * person + 0.03 * np.sin(np.pi * steps * frames / rate + person)
    return [(person, f, a, b) for f, a, b in zip(frames.tolist(), x, y, strict=True)]


@pytest.mark.parametrize("rate", [10.0, 16.0, 25.0, 50.0])
def test_frame_rates_are_guessed_by_steps_and_said(file, rate):
    rows = [row for p in range(12) for row in swaying(rate, p, 0.8 + 0.06 * p)]
    with pytest.warns(UserWarning, match=f"taken to have {rate:g} frames a second: steps in"):
        tracks = Trajectories.read(file(text(rows)), unit="m")
    assert tracks.frame_rate == rate


def test_rates_by_steps_are_near_the_true_one():
    rows = np.array([row for p in range(12) for row in swaying(20.0, p, 0.8 + 0.06 * p)])
    person, frame = rows[:, 0].astype(int), rows[:, 1].astype(int)
    found = gait_rates(Rows(person, frame, *rows[:, 2:].T), 1.0)
    assert np.median(found) == pytest.approx(20.0, rel=0.05)


def test_a_rate_that_steps_do_not_show_is_not_guessed(file):
    rng = np.random.default_rng(1)
    rows = [(p, f, 0.05 * f, 1.2 * p + rng.normal(0, 0.03)) for p in range(12) for f in range(300)]
    with pytest.raises(ResultsError, match="no frame rate in it: give it, as in frame_rate=16"):
        Trajectories.read(file(text(rows)), unit="m")


def test_a_fifth_column_is_read_where_it_is_an_elevation(file):
    """Two people right above each other, on floors 3 m apart: nothing is wrong with their unit."""
    rows = [(p, f, 10.0 * f, 300.0 * p) for f in range(40) for p in (0, 1)]
    lines = "".join(f"{p} {f} {x:g} 0 {z:g}\n" for p, f, x, z in rows)
    assert "z" not in quiet(file(HEADER + lines), unit="cm").fields
    tracks = quiet(file(HEADER + "# z is the elevation of the floor\n" + lines))
    assert tracks.z.tolist() == [0.0, 3.0] * 40
    assert tracks.x.max() == pytest.approx(3.9)
    short = file(HEADER + "# z is the elevation of the floor\n" + lines + "7 0 1 1\n")
    with pytest.warns(UserWarning, match="line 84: '7 0 1 1', expected id, frame, x, y"):
        assert len(Trajectories.read(short)) == 80
