"""Pages of PDF files."""

import base64
import io
import random

import pytest
from matplotlib.figure import Figure
from PIL import Image

from mesa_mobility.dashboard.board import pages
from mesa_mobility.dashboard.board.pages import picture_of
from mesa_mobility.errors import MobilityError

pytest.importorskip("pypdfium2", reason="no pypdfium2: pip install 'mesa-mobility[pdf]'")


def drawn(width, height):
    file = io.BytesIO()
    figure = Figure(figsize=(width, height))
    figure.subplots()
    # The same bytes at any time, since processes that share the tests compare names of cases.
    figure.savefig(file, format="pdf", metadata={"CreationDate": None})
    return file.getvalue()


def encoded(data):
    return base64.b64encode(data).decode()


def test_a_page_has_the_shape_of_the_paper():
    found = picture_of(encoded(drawn(6, 3)), 1)
    assert found["pages"] == 1
    kind, _, text = found["picture"].partition(",")
    assert kind == "data:image/png;base64"
    assert Image.open(io.BytesIO(base64.b64decode(text))).size == (2400, 1200)


@pytest.mark.parametrize(
    ("data", "page", "said"),
    [
        (None, 1, "expected at most 10 MB"),
        ("A" * 14_000_000, 1, "expected at most 10 MB"),
        ("?", 1, "PDF: cannot be read"),
        (encoded(b"no"), 1, "PDF: cannot be read"),
        (encoded(drawn(2, 2)), 2, "has 1 pages, expected one of them, found 2"),
        (encoded(drawn(2, 2)), 0, "got page 0"),
        (encoded(drawn(2, 2)), "1", "got page '1'"),
    ],
    ids=["none", "large", "letters", "words", "second of one", "zeroth", "text"],
)
def test_what_is_no_page_is_said_in_one_line(data, page, said):
    with pytest.raises(MobilityError, match=said) as refused:
        picture_of(data, page)
    assert "\n" not in str(refused.value)


def test_a_missing_library_is_named(monkeypatch):
    monkeypatch.setattr(pages, "find_spec", lambda name: None)
    with pytest.raises(MobilityError, match=r"pip install 'mesa-mobility\[pdf\]'"):
        picture_of("", 1)


@pytest.mark.parametrize(
    "count",
    [pytest.param(5, marks=pytest.mark.thorough), pytest.param(300, marks=pytest.mark.slow)],
)
def test_damaged_files_are_pages_or_refused(count):
    whole, draw = drawn(3, 2), random.Random(1)
    for _ in range(count):
        data = bytearray(whole)
        for _ in range(draw.choice((1, 4, 20))):
            data[draw.randrange(len(data))] = draw.randrange(256)
        try:
            said = picture_of(encoded(bytes(data[: draw.choice((len(data), 900))])), 1)["picture"]
        except MobilityError as error:
            said = str(error)
        assert said
        assert "\n" not in said
