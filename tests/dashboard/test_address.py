"""The page's address holds the state of the run."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

pytest.importorskip("solara", reason="no solara: pip install 'mesa-mobility[viz]'")

from mesa_mobility.dashboard.address import Start, read, write

words = st.text(st.characters(exclude_categories=["Cs"]), min_size=1, max_size=8)
weights = st.tuples(st.booleans(), st.floats(-1e9, 1e9))
starts = st.builds(
    Start,
    words,
    words,
    st.dictionaries(words, st.text(st.characters(exclude_categories=["Cs"]), max_size=8)),
    st.dictionaries(words, weights),
    words,
)


@given(starts)
def test_what_is_written_is_read_again(start):
    assert read(write(start)) == start


@given(st.text(max_size=60))
def test_any_text_is_an_address(text):
    found = read(text)
    assert read(write(found)) == found


def test_an_address_can_be_read():
    start = Start("k", "doorway", {"pedestrians": "25"}, {"headway": (False, 2.0)}, "quickest_exit")
    assert write(start) == (
        "run=k&model=doorway&where=quickest_exit&set.pedestrians=25&weight.headway=2.0%2Coff"
    )
    assert read("weight.headway=high&weight.stepping=nan&weight.speed=2") == Start(
        behaviours={"speed": (True, 2.0)}
    )
