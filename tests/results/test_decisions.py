import numpy as np
import pytest

from mesa_mobility.errors import ResultsError
from mesa_mobility.results.decisions import Decisions, read_decisions


def some(**changes) -> Decisions:
    fields = {
        "frame": np.array([0, 0, 12], np.int32),
        "person": np.array([1, 0, 1], np.int32),
        "type_index": np.zeros(3, np.int32),
        "option": np.array([7, -2, 3], np.int32),
        "share": np.array([1.0, 1.0, 0.25], np.float32),
        "maps": ("abc",),
    }
    return Decisions(**{**fields, **changes})


def test_decisions_read_back_unchanged_and_in_the_same_bytes(tmp_path):
    one, two = tmp_path / "one.parquet", tmp_path / "two.parquet"
    some().to_parquet(one)
    again = read_decisions(one)
    again.to_parquet(two)
    assert one.read_bytes() == two.read_bytes()
    assert again.maps == ("abc",)
    assert again.option.tolist() == [7, -2, 3]


def test_movements_of_a_person_come_in_order_of_time():
    movements = some().movements_of(1)
    assert movements.starts.tolist() == [0, 12]
    assert movements.options.tolist() == [7, 3]
    assert movements.shares.tolist() == [1.0, 0.25]
    assert len(some().movements_of(5).starts) == 0


@pytest.mark.parametrize(
    ("changes", "what"),
    [
        ({"frame": np.array([5, 0, 12], np.int32)}, "go back"),
        ({"option": np.array([1], np.int32)}, "option: shape"),
        (
            {"type_index": np.array([0, 0, 1], np.int32)},
            r"type_index\[2\]: got 1, expected a number, finite, 0 to 0",
        ),
    ],
)
def test_decisions_that_cannot_be_are_refused(changes, what):
    with pytest.raises(ResultsError, match=what):
        some(**changes)


def test_any_changed_byte_is_found(tmp_path):
    path = tmp_path / "decisions.parquet"
    some().to_parquet(path)
    content = path.read_bytes()
    for place in range(0, len(content), 37):
        spoilt = bytearray(content)
        spoilt[place] ^= 1
        path.write_bytes(bytes(spoilt))
        with pytest.raises(ResultsError, match=r"decisions\.parquet"):
            read_decisions(path)
    with pytest.raises(ResultsError, match="no such file"):
        read_decisions(tmp_path / "absent.parquet")
