import json

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from mesa_mobility.errors import ResultsError
from mesa_mobility.results import Trajectories, read_parquet

COLUMNS = ("frame", "person", "x", "y", "heading")
number = st.floats(allow_nan=False, allow_infinity=False)


@given(values=arrays(np.float64, (3, 6), elements=number), rate=st.floats(0.1, 240.0))
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=50)
def test_reading_back_gives_every_bit(values, rate, tmp_path):
    run = Trajectories(
        frame=[0, 0, 1, 1, 2, 2],
        person=[0, 3, 0, 3, 0, 3],
        x=values[0],
        y=values[1],
        heading=values[2],
        frame_rate=rate,
        core_radius=[0.15, 0.2, 0.1, 0.3],
        last_frame=2,
        inside_at_end=[3],
    )
    run.to_parquet(tmp_path / "run.parquet")
    back = read_parquet(tmp_path / "run.parquet")
    for name in (*COLUMNS, "radii", "remaining"):
        first, second = getattr(run, name), getattr(back, name)
        assert first.dtype == second.dtype
        assert first.tobytes() == second.tobytes()
    assert (back.frame_rate, back.frames) == (rate, 3)


def test_other_programs_find_columns_units_and_compression(two_leave_one_stays, tmp_path):
    two_leave_one_stays.to_parquet(tmp_path / "run.parquet")
    file = pq.ParquetFile(tmp_path / "run.parquet")
    schema = file.schema_arrow
    assert [(field.name, str(field.type)) for field in schema] == [
        ("frame", "int32"), ("person", "int32"), ("x", "double"), ("y", "double"),
        ("heading", "double"),
    ]  # fmt: skip
    assert json.loads(schema.metadata[b"mesa_mobility"]) == {
        "format_version": 1,
        "frame_rate": 2.0,
        "last_frame": 4,
        "core_radius": [0.15, 0.15, 0.15],
        "inside_at_end": [1],
    }
    assert {file.metadata.row_group(0).column(k).compression for k in range(5)} == {"ZSTD"}


def test_equal_runs_give_equal_bytes(two_leave_one_stays, tmp_path):
    for name in ("a", "b"):
        two_leave_one_stays.to_parquet(tmp_path / name)
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()


def test_empty_run_comes_back(walk, tmp_path):
    walk({}, last_frame=9).to_parquet(tmp_path / "run.parquet")
    back = read_parquet(tmp_path / "run.parquet")
    assert (len(back), back.frames) == (0, 10)


@pytest.mark.parametrize(
    ("damage", "message"),
    [
        (lambda data: b"", "not a readable Parquet file"),
        (lambda data: b"frame,person,x,y", "not a readable Parquet file"),
        (lambda data: data[: len(data) // 2], "not a readable Parquet file"),
    ],
)
def test_damaged_files_are_refused(two_leave_one_stays, tmp_path, damage, message):
    path = tmp_path / "run.parquet"
    two_leave_one_stays.to_parquet(path)
    path.write_bytes(damage(path.read_bytes()))
    with pytest.raises(ResultsError, match=f"run.parquet: {message}") as caught:
        read_parquet(path)
    assert "\n" not in str(caught.value)


def test_missing_file_is_named(tmp_path):
    with pytest.raises(ResultsError, match=r"run\.parquet: no such file"):
        read_parquet(tmp_path / "run.parquet")


GOOD = {
    "format_version": 1,
    "frame_rate": 30.0,
    "last_frame": 1,
    "core_radius": [0.15],
    "inside_at_end": [0],
}


@pytest.mark.parametrize(
    ("columns", "metadata", "message"),
    [
        ({"y": None}, GOOD, "no column y"),
        ({}, None, "no mesa_mobility metadata"),
        ({}, GOOD | {"format_version": 2}, "format version 2, expected 1"),
        ({}, {"format_version": 1}, "damaged trajectories: 'frame_rate'"),
        ({}, GOOD | {"frame_rate": "fast"}, "damaged trajectories"),
        ({}, GOOD | {"core_radius": []}, "core_radius has shape"),
        ({"x": [0.0, float("nan")]}, GOOD, "x of row 1 is nan"),
        ({"x": ["here", "there"]}, GOOD, "damaged trajectories"),
        ({"x": [0.0, None]}, GOOD, "x of row 1 is nan"),
    ],
)
def test_parquet_of_something_else_is_refused(tmp_path, columns, metadata, message):
    values = {"frame": [0, 1], "person": [0, 0], "x": [0.0, 1.0], "y": [0.0, 0.0]}
    values |= {"heading": [0.0, 0.0]} | columns
    table = pa.table({name: column for name, column in values.items() if column is not None})
    if metadata is not None:
        table = table.replace_schema_metadata({"mesa_mobility": json.dumps(metadata)})
    pq.write_table(table, tmp_path / "other.parquet")
    with pytest.raises(ResultsError, match=r"other\.parquet: ") as caught:
        read_parquet(tmp_path / "other.parquet")
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_folder_that_is_not_there_is_named(two_leave_one_stays, tmp_path):
    with pytest.raises(ResultsError, match=r"away/run\.parquet: cannot be written"):
        two_leave_one_stays.to_parquet(tmp_path / "away" / "run.parquet")
