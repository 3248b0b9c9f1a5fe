import binascii
import math
import sqlite3
import sys

import numpy as np
import pytest
import shapely

from mesa_mobility.errors import ResultsError
from mesa_mobility.results import (
    Trajectories,
    density,
    occupancy,
    to_pedpy,
    write_juelich_text,
    write_jupedsim_sqlite,
)
from mesa_mobility.results.formats import export


@pytest.fixture
def pedpy():
    return pytest.importorskip("pedpy")


@pytest.fixture
def run(two_leave_one_stays):
    return two_leave_one_stays


# Of two_leave_one_stays: persons 0 and 2 walk on at 1.1 m and 1.5 m a frame, person 1 is inside.
BEYOND = [
    (3, 0, 11.2, 2.0),
    (4, 0, 12.3, 2.0),
    (5, 0, 13.4, 2.0),
    (5, 2, 12.0, 2.0),
    (6, 2, 13.5, 2.0),
    (7, 2, 15.0, 2.0),
]


def exported(run):
    """(n, 4) rows of frame, person, x and y of an export, in this order."""
    rows = np.vstack([np.column_stack((run.frame, run.person, run.x, run.y)), BEYOND])
    return rows[np.lexsort((rows[:, 1], rows[:, 0]))]


def test_everybody_who_leaves_crosses_the_line_of_the_exit(run, room, pedpy, tmp_path):
    write_jupedsim_sqlite(run, tmp_path / "run.sqlite", room.free)
    write_juelich_text(run, tmp_path / "run.txt")
    line = pedpy.MeasurementLine([(10, 1), (10, 3)])
    for data in (
        run.to_pedpy(),
        pedpy.load_trajectory_from_jupedsim_sqlite(trajectory_file=tmp_path / "run.sqlite"),
        pedpy.load_trajectory(trajectory_file=tmp_path / "run.txt"),
    ):
        nt, crossed = pedpy.compute_n_t(traj_data=data, measurement_line=line)
        assert crossed[["id", "frame"]].to_numpy().tolist() == [[0, 2], [2, 4]]
        assert nt.cumulative_pedestrians.max() == 2
    # Whatever is measured here has nobody beyond an exit.
    assert occupancy(run, every=0.5) == [[0.0, 2], [0.5, 3], [1.0, 2], [1.5, 2], [2.0, 1]]


def test_a_person_of_a_single_row_does_not_walk_on(walk):
    run = walk({0: (2, [(1.0, 1.0)])}, inside_at_end=np.empty(0, dtype=int), last_frame=4)
    assert len(export.walked_on(run)) == 1


def test_pedpy_gets_every_row(run, pedpy):
    data = run.to_pedpy()
    assert isinstance(data, pedpy.TrajectoryData)
    assert data.frame_rate == 2.0
    rows = data.data[["frame", "id", "x", "y"]].to_numpy().tolist()
    assert np.array(rows) == pytest.approx(exported(run))


def test_pedpy_measures_the_same_density(run, pedpy):
    box = shapely.box(7.5, 0, 10, 4)
    theirs = pedpy.compute_classic_density(
        traj_data=run.to_pedpy(), measurement_area=pedpy.MeasurementArea(box)
    )
    ours = density(run, box, every=0.5)
    # Frame by frame: 0 at 8; 0 at 9; 2 at 8; 2 at 9; nobody.  10 m2.
    assert [value for _, value in ours] == [0.1, 0.1, 0.1, 0.1, 0.0]
    # The rows beyond the exit change nothing within the floor.
    assert theirs["density"].tolist()[:5] == [value for _, value in ours]
    assert set(theirs["density"].tolist()[5:]) == {0.0}


def test_without_pedpy_it_says_how_to_get_it(run, monkeypatch):
    monkeypatch.setitem(sys.modules, "pedpy", None)
    with pytest.raises(ResultsError, match="pip install pedpy"):
        to_pedpy(run)


def test_jupedsim_database_reads_in_pedpy(run, room, pedpy, tmp_path):
    path = tmp_path / "run.sqlite"
    write_jupedsim_sqlite(run, path, room.free)
    data = pedpy.load_trajectory_from_jupedsim_sqlite(trajectory_file=path)
    assert data.frame_rate == 2.0
    assert data.data[["frame", "id", "x", "y"]].to_numpy() == pytest.approx(exported(run))
    area = pedpy.load_walkable_area_from_jupedsim_sqlite(trajectory_file=path)
    assert area.polygon.equals(room.free)
    assert area.polygon.area == pytest.approx(39.0)


def test_jupedsim_database_has_what_its_viewer_asks_for(room, tmp_path):
    path = tmp_path / "run.sqlite"
    run = Trajectories(
        frame=[0, 2], person=[7, 7], x=[1.0, 2.0], y=[3.5, 0.5], heading=[0.0, math.pi / 2]
    )
    write_jupedsim_sqlite(run, path, room.free)
    connection = sqlite3.connect(path)
    try:
        metadata = dict(connection.execute("SELECT key, value FROM metadata"))
        frames = connection.execute("SELECT frame, geometry_hash FROM frame_data").fetchall()
        geometry = connection.execute("SELECT hash FROM geometry").fetchall()
        rows = connection.execute("SELECT * FROM trajectory_data").fetchall()
    finally:
        connection.close()
    assert metadata == {
        "version": "2",
        "fps": "30.0",
        "xmin": "1.0",
        "xmax": "2.0",
        "ymin": "0.5",
        "ymax": "3.5",
    }
    # A frame without anybody is a frame too.
    assert [frame for frame, _ in frames] == [0, 1, 2]
    # The same in every process: a checksum of the text.
    assert (
        {key for _, key in frames} == {geometry[0][0]} == {binascii.crc32(room.free.wkt.encode())}
    )
    assert rows[0] == (0, 7, 1.0, 3.5, 1.0, 0.0)
    assert rows[1] == (2, 7, 2.0, 0.5, pytest.approx(0.0, abs=1e-12), 1.0)


def test_juelich_text_reads_in_pedpy(run, pedpy, tmp_path):
    path = tmp_path / "run.txt"
    write_juelich_text(run, path)
    data = pedpy.load_trajectory(trajectory_file=path)
    assert data.frame_rate == 2.0
    rows = exported(run)
    assert data.data[["frame", "id", "x", "y"]].to_numpy() == pytest.approx(
        rows[np.lexsort((rows[:, 0], rows[:, 1]))]
    )


def test_juelich_text_is_as_the_archive_writes_it(walk, tmp_path):
    path = tmp_path / "run.txt"
    write_juelich_text(walk({3: (1, [(0.12344, -2.0)])}, frame_rate=12.5), path)
    assert path.read_text() == "# framerate: 12.5\n# id frame x/m y/m z/m\n3 1 0.1234 -2.0000 0\n"


@pytest.mark.parametrize("writer", [write_juelich_text, write_jupedsim_sqlite])
def test_exports_are_whole_or_absent(writer, walk, run, room, tmp_path):
    area = (room.free,) if writer is write_jupedsim_sqlite else ()
    with pytest.raises(ResultsError, match="nothing to export"):
        writer(walk({}), tmp_path / "empty", *area)
    with pytest.raises(ResultsError, match=r"away/run: cannot be written"):
        writer(run, tmp_path / "away" / "run", *area)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("writer", [write_juelich_text, write_jupedsim_sqlite])
def test_rows_go_out_in_portions(writer, run, room, tmp_path, monkeypatch):
    area = (room.free,) if writer is write_jupedsim_sqlite else ()
    writer(run, tmp_path / "at once", *area)
    monkeypatch.setattr(export, "CHUNK", 5)
    writer(run, tmp_path / "in portions", *area)
    assert (tmp_path / "in portions").read_bytes() == (tmp_path / "at once").read_bytes()


@pytest.mark.parametrize("writer", [write_juelich_text, write_jupedsim_sqlite])
def test_equal_runs_give_equal_exports(writer, run, room, tmp_path):
    area = (room.free,) if writer is write_jupedsim_sqlite else ()
    for name in ("a", "b", "a"):
        writer(run, tmp_path / name, *area)
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a", "b"]


def test_juelich_text_of_a_building_has_elevations(walk, pedpy, tmp_path):
    """Down a stair of 1 m a frame at 1 Hz, and out at x = 3; with nothing said of z, it is 0."""
    points = [(0.0, 1.0), (1.0, 1.0), (2.0, 1.0), (3.5, 1.0)]
    z = np.array([1.0, 0.5, 0.12345, 0.0])
    last = {"inside_at_end": np.empty(0, dtype=int), "frame_rate": 1.0}
    write_juelich_text(walk({0: (0, points)}, fields={"z": z}, **last), tmp_path / "stair.txt")
    assert (tmp_path / "stair.txt").read_text().splitlines() == [
        "# framerate: 1",
        "# id frame x/m y/m z/m",
        "# z is the elevation of the floor",
        "0 0 0.0000 1.0000 1.0000",
        "0 1 1.0000 1.0000 0.5000",
        "0 2 2.0000 1.0000 0.1235",
        "0 3 3.5000 1.0000 0.0000",
        "0 4 5.0000 1.0000 0.0000",
        "0 5 6.5000 1.0000 0.0000",
        "0 6 8.0000 1.0000 0.0000",
    ]
    data = pedpy.load_trajectory(trajectory_file=tmp_path / "stair.txt")
    assert len(data.data) == 7
    write_juelich_text(walk({0: (0, points)}, **last), tmp_path / "floor.txt")
    assert (tmp_path / "floor.txt").read_text().splitlines()[1:3] == [
        "# id frame x/m y/m z/m",
        "0 0 0.0000 1.0000 0",
    ]
