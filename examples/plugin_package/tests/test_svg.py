import random

import pytest
from crowd_extras.svg import Svg

from mesa_mobility import FloorPlan
from mesa_mobility.errors import MobilityError

DRAWING = """<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 1200 800">
<rect class="room" id="hall" x="0" y="0" width="800" height="800"/>
<polygon class="room" id="lobby" points="800,0 1200,0 1200,400 800,400"/>
<rect class="obstacle" x="200" y="200" width="100" height="50"/>
<line class="gate" id="arch" x1="800" y1="100" x2="800" y2="300"/>
<line class="exit" id="street" x1="1200" y1="100" x2="1200" y2="300"/>
<text class="title">A hall</text>
</svg>"""


@pytest.fixture
def path(tmp_path):
    """A drawing in centimetres."""
    file = tmp_path / "hall.svg"
    file.write_text(DRAWING)
    return file


def test_shapes_are_what_their_classes_say(path):
    found = Svg().read(path, unit=0.01)
    assert found.walkable.area == pytest.approx(8 * 8 + 4 * 4)
    # y grows upwards in a plan: what is 2 m below the top of the drawing is at -2.
    assert found.obstacles[0].bounds == (2.0, -2.5, 3.0, -2.0)
    assert (found.exits[0].name, found.exits[0].a) == ("street", (12.0, -1.0))
    assert [each.name for each in found.rooms] == ["hall", "lobby"]
    assert found.notes == ["left out title 7: its class is 'title'"]


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("</svg>", "", "cannot be read as SVG"),
        ('x="200"', 'x="2m"', "expected coordinates"),
        ("800,0 1200,0", "800", "expected coordinates"),
        ('id="hall"', 'id="hall" transform="scale(2)"', "hall has a transform"),
        ('points="800,0 1200,0 1200,400 800,400"', 'points="800,0 1,1"', "too few points"),
    ],
)
def test_faulty_drawings_are_refused_in_one_line(path, old, new, said):
    path.write_text(DRAWING.replace(old, new, 1))
    with pytest.raises(MobilityError, match=said) as refused:
        Svg().read(path)
    assert "\n" not in str(refused.value)


def test_damaged_drawings_are_plans_or_refused(path):
    draw = random.Random(1)
    plans, said = 0, []
    for _ in range(60):
        data = bytearray(DRAWING.encode())
        for _ in range(draw.choice((1, 2, 5))):
            data[draw.randrange(len(data))] = draw.choice(b'0.-9<>"a\x00\xff ')
        path.write_bytes(data)
        try:
            content = Svg().read(path, unit=0.01)
            FloorPlan(content.walkable, exits=content.exits, gates=content.gates)
            plans += 1
        except MobilityError as error:
            said.append(str(error))
    assert plans > 0
    assert not any("\n" in each for each in said)
