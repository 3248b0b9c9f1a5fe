"""What is known of people besides their places, and figures by it."""

import sqlite3

import numpy as np
import pytest

from mesa_mobility.errors import ResultsError
from mesa_mobility.results import (
    Trajectories,
    by_type,
    occupancy_by_type,
    plot_occupancy,
    plot_snapshots,
    read_parquet,
    write_jupedsim_sqlite,
)
from tests.fixtures.maps import strider
from tests.fixtures.scenes import advance, corridor, model_of

DATA = {
    "type": np.array(["child", "adult", "child"]),
    "group": np.array(["", "family", "family"]),
    "age": np.array([9, 40, 11]),
}


@pytest.fixture
def three(walk) -> Trajectories:
    """At 2 Hz, 1 m a frame: child 0 leaves in frame 2, adult 1 stays, child 2 in frames 1 to 5."""
    return walk(
        {
            0: (0, [(8.0, 2.0), (9.0, 2.0), (10.0, 2.0)]),
            1: (0, [(1.0 + 0.5 * k, 1.0) for k in range(6)]),
            2: (1, [(6.0 + k, 2.0) for k in range(5)]),
        },
        frame_rate=2.0,
        inside_at_end=np.array([1]),
        person_data=DATA,
    )


def test_a_row_for_each_type(three):
    table = by_type(three)
    assert table.index.tolist() == ["adult", "child"]
    assert table["people"].tolist() == [1, 2]
    assert table["left"].tolist() == [0, 2]
    # Child 0 is there for 1 s, child 2 for 2 s.
    assert np.isnan(table.loc["adult", "mean_egress_s"])
    assert table.loc["child", "mean_egress_s"] == 1.5
    assert table.loc["child", "p95_egress_s"] == pytest.approx(1.0 + 0.95 * 1.0)
    # 0.5 m and 1 m a frame of half a second.
    assert table["mean_speed_mps"].tolist() == pytest.approx([1.0, 2.0])


def test_people_inside_count_as_later_than_all_others(walk):
    """At 1 Hz: of 30 people, 28 are out after 0 to 27 s, and two never."""
    tracks = {k: (0, [(0.1 * t, 1.0 + k) for t in range(k + 1)]) for k in range(28)}
    tracks |= {k: (0, [(0.0, 1.0 + k)] * 40) for k in (28, 29)}
    crowd = walk(
        tracks,
        frame_rate=1.0,
        inside_at_end=np.array([28, 29]),
        person_data={"type": np.array(["all"] * 30)},
    )
    [row] = by_type(crowd).to_dict("records")
    assert (row["people"], row["left"]) == (30, 28)
    # The 95th percentile lies between the 28th and the 29th, who has not left.
    assert np.isnan(row["mean_egress_s"])
    assert np.isnan(row["p95_egress_s"])
    shorter = crowd.of_people(np.array([*range(28), 29]))
    [row] = by_type(shorter).to_dict("records")
    # Of 29 it lies between the 27th, after 26 s, and the 28th.
    assert row["p95_egress_s"] == pytest.approx(26.0 + 0.95 * 28 - 26)


def test_any_data_tell_people_apart(three):
    assert by_type(three, "group")["people"].to_dict() == {"": 1, "family": 2}
    with pytest.raises(
        ResultsError, match="no person_data 'sex', expected one of: type, group, age"
    ):
        by_type(three, "sex")


def test_occupancy_by_type(three):
    assert occupancy_by_type(three, every=0.5) == {
        "adult": [[0.5 * k, 1] for k in range(6)],
        "child": [[0.0, 1], [0.5, 2], [1.0, 1], [1.5, 1], [2.0, 1], [2.5, 0]],
    }


def test_a_data_frame_with_all_of_it(three):
    frame = three.to_pandas()
    assert frame.columns.tolist() == ["frame", "person", "x", "y", "heading", *DATA]
    assert len(frame) == 14
    assert frame.groupby("type", observed=True)["person"].nunique().to_dict() == {
        "adult": 1,
        "child": 2,
    }
    assert (frame["age"].to_numpy() == DATA["age"][frame["person"]]).all()
    assert frame["type"].cat.categories.tolist() == ["adult", "child"]


def test_data_of_people_are_columns_of_the_file(three, tmp_path):
    import pyarrow.parquet as pq

    three.to_parquet(tmp_path / "t.parquet")
    table = pq.read_table(tmp_path / "t.parquet")
    assert table.column_names == ["frame", "person", "x", "y", "heading", *DATA]
    assert table["type"].to_pylist() == DATA["type"][three.person].tolist()
    read = read_parquet(tmp_path / "t.parquet")
    assert {name: values.tolist() for name, values in read.person_data.items()} == {
        name: values.tolist() for name, values in DATA.items()
    }
    read.to_parquet(tmp_path / "again.parquet")
    assert (tmp_path / "again.parquet").read_bytes() == (tmp_path / "t.parquet").read_bytes()


def test_trajectories_without_data_or_rows(walk, tmp_path):
    for given in (
        walk({0: (0, [(1.0, 1.0)])}),
        walk({}, person_data={"type": np.array([], dtype=str)}),
    ):
        given.to_parquet(tmp_path / "t.parquet")
        assert set(read_parquet(tmp_path / "t.parquet").person_data) == set(given.person_data)


def test_jupedsim_has_them_in_a_table_beside_its_own(three, tmp_path):
    write_jupedsim_sqlite(three, tmp_path / "t.sqlite", corridor().free)
    with sqlite3.connect(tmp_path / "t.sqlite") as connection:
        rows = connection.execute("SELECT id, type, age FROM person_data").fetchall()
    assert rows == [(0, "child", 9), (1, "adult", 40), (2, "child", 11)]


def test_pictures_of_several_types(three, room, tmp_path):
    plot_occupancy([[0.0, 3], [1.0, 2]], tmp_path / "o.png", by_type=occupancy_by_type(three))
    plot_snapshots(three, room, tmp_path / "s.png", times=[0.0, 1.0])
    for name in ("o", "s"):
        assert (tmp_path / f"{name}.png").stat().st_size > 1000


@pytest.mark.parametrize(
    ("data", "match"),
    [
        ({"x": [1, 2, 3]}, "person_data 'x', expected a name of its own"),
        ({"of whom": [1, 2, 3]}, "'of whom', expected a name"),
        ({"type": ["a", "b"]}, "'type' has <U1 in shape .2,., expected texts or numbers"),
        ({"type": [None, "b", "c"]}, "'type' has object"),
    ],
)
def test_data_that_will_not_do(walk, data, match):
    with pytest.raises(ResultsError, match=match):
        walk({2: (0, [(1.0, 1.0)])}, person_data=data)


def test_a_models_people_have_type_and_group():
    model = model_of(corridor(), strider())
    model.add_pedestrians([(1, 1)], group=7)
    model.add_pedestrians([(1, 3)])
    advance(model, 3)
    data = Trajectories.of(model).person_data
    assert data["type"].tolist() == ["made by hand"] * 2
    assert data["group"].tolist() == ["7", ""]


def test_a_model_may_add_data():
    model = model_of(corridor(), strider())
    model.add_pedestrians([(1, 1), (1, 3)])
    data = {**model.person_data(), "age": [30, 40]}
    model.person_data = lambda: data
    advance(model, 3)
    assert Trajectories.of(model).to_pandas()["age"].tolist()[:2] == [30, 40]
