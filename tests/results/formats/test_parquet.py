import hashlib
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
from mesa_mobility.results.seal import UNSEALED, seal

COLUMNS = ("frame", "person", "x", "y", "heading")
number = st.floats(allow_nan=False, allow_infinity=False)


@given(values=arrays(np.float64, (3, 6), elements=number), rate=st.floats(0.1, 240.0))
@settings(
    suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=50, deadline=None
)
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
        ("frame", "int32"),
        ("person", "int32"),
        ("x", "double"),
        ("y", "double"),
        ("heading", "double"),
    ]
    metadata = json.loads(schema.metadata[b"mesa_mobility"])
    content = (tmp_path / "run.parquet").read_bytes()
    zeros = content.replace(metadata["sha256"].encode(), b"0" * 64)
    assert metadata.pop("sha256") == hashlib.sha256(zeros).hexdigest()
    assert metadata == {
        "format_version": 2,
        "frame_rate": 2.0,
        "last_frame": 4,
        "core_radius": [0.15, 0.15, 0.15],
        "inside_at_end": [1],
        "person_data": [],
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


def flipped(content, bit):
    damaged = bytearray(content)
    damaged[bit // 8] ^= 1 << bit % 8
    return bytes(damaged)


@pytest.fixture
def written(two_leave_one_stays, tmp_path):
    path = tmp_path / "run.parquet"
    two_leave_one_stays.to_parquet(path)
    return path


def test_a_single_bit_flipped_anywhere_is_noticed(written):
    content = written.read_bytes()
    step = max(1, 8 * len(content) // 400)
    for bit in range(0, 8 * len(content), step):
        written.write_bytes(flipped(content, bit))
        with pytest.raises(ResultsError, match=r"run\.parquet: ") as caught:
            read_parquet(written)
        assert "\n" not in str(caught.value)


@pytest.mark.slow
def test_every_single_bit_flipped_is_noticed(written):
    content = written.read_bytes()
    for bit in range(8 * len(content)):
        written.write_bytes(flipped(content, bit))
        with pytest.raises(ResultsError):
            read_parquet(written)


def test_bytes_added_removed_or_moved_are_noticed(written):
    content = written.read_bytes()
    for other in (
        content + b"\0",
        b"\0" + content,
        content[:40] + content[41:],
        content[:40] + content[39:],
        content[4:20] + content[:4] + content[20:],
        content + content,
    ):
        written.write_bytes(other)
        with pytest.raises(ResultsError, match=r"run\.parquet: "):
            read_parquet(written)


def test_other_readers_can_check_the_pages(written):
    content = written.read_bytes()
    column = pq.ParquetFile(written).metadata.row_group(0).column(2)
    # The last byte of the only page of x.
    at = column.data_page_offset + column.total_compressed_size - 1
    written.write_bytes(flipped(content, 8 * at))
    with pytest.raises(OSError, match="CRC checksum"):
        pq.read_table(written, page_checksum_verification=True)


def test_missing_file_is_named(tmp_path):
    with pytest.raises(ResultsError, match=r"run\.parquet: no such file"):
        read_parquet(tmp_path / "run.parquet")


GOOD = {
    "format_version": 2,
    "sha256": UNSEALED,
    "frame_rate": 30.0,
    "last_frame": 1,
    "core_radius": [0.15],
    "inside_at_end": [0],
}


def write(table, path, metadata):
    table = table.replace_schema_metadata(None)
    with pq.ParquetWriter(path, table.schema, store_schema=False) as writer:
        writer.write_table(table)
        if metadata is not None:
            writer.add_key_value_metadata({"mesa_mobility": metadata})


@pytest.mark.parametrize(
    ("columns", "metadata", "message"),
    [
        ({"y": None}, GOOD, "no column y"),
        ({}, None, "no sha256 in mesa_mobility metadata, expected a file of mesa-mobility"),
        ({}, {"format_version": 1}, "no sha256 in mesa_mobility metadata"),
        ({}, GOOD | {"format_version": 1}, "format version 1, expected 2"),
        ({}, {"format_version": 2, "sha256": UNSEALED}, "damaged trajectories: 'frame_rate'"),
        ({}, GOOD | {"last_frame": 1e999}, "damaged trajectories: cannot convert float infinity"),
        ({}, GOOD | {"last_frame": 10**12}, "last_frame is 1000000000000, expected at most"),
        ({}, GOOD | {"inside_at_end": [10**30]}, "damaged trajectories: "),
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
    write(table, tmp_path / "other.parquet", metadata and json.dumps(metadata))
    if metadata is not None and "sha256" in metadata:
        seal(tmp_path / "other.parquet")
    with pytest.raises(ResultsError, match=r"other\.parquet: ") as caught:
        read_parquet(tmp_path / "other.parquet")
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


def test_discs_of_earlier_versions_are_ignored(two_leave_one_stays, tmp_path):
    path = tmp_path / "run.parquet"
    two_leave_one_stays.to_parquet(path)
    table = pq.read_table(path)
    metadata = json.loads(table.schema.metadata[b"mesa_mobility"])
    metadata |= {"discs": [[[-0.1, 0.2], [0.0, 0.2], [0.0, 0.0]]] * 3, "sha256": UNSEALED}
    write(table, path, json.dumps(metadata))
    seal(path)
    assert read_parquet(path).radii.tolist() == two_leave_one_stays.radii.tolist()


def test_metadata_nested_too_deeply_are_refused(written):
    deep = "[" * 100_000 + "]" * 100_000
    metadata = f'{{"sha256": "{UNSEALED}", "format_version": {deep}}}'
    write(pq.read_table(written), written, metadata)
    seal(written)
    with pytest.raises(ResultsError, match=r"run\.parquet: ") as caught:
        read_parquet(written)
    assert "\n" not in str(caught.value)


def test_a_folder_that_is_not_there_is_named(two_leave_one_stays, tmp_path):
    with pytest.raises(ResultsError, match=r"away/run\.parquet: cannot be written"):
        two_leave_one_stays.to_parquet(tmp_path / "away" / "run.parquet")
