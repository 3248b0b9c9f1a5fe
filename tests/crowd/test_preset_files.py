"""Files of presets: written, read, and checked."""

import tomllib
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mesa_mobility import PedestrianModel
from mesa_mobility.crowd import PRESETS, Provenance, read_preset, write_preset
from mesa_mobility.crowd.presets.files import parse_preset, preset_text
from mesa_mobility.errors import ModelError
from tests.fixtures.maps import strider
from tests.fixtures.scenes import corridor

DIGEST = "0123456789abcdef" * 4
MINIMAL = """
name = "mine"
target_choice = "nearest_exit"
tactics = ["visits"]
durations = [12]
hard_bodies = true
[terms]
headway = 1.5
"""


@pytest.fixture
def file(tmp_path):
    return tmp_path / "mine.toml"


@pytest.mark.parametrize("name", PRESETS)
def test_what_ships_is_read_as_it_was_written(name, file):
    write_preset(PRESETS[name], file)
    found = read_preset(file)
    assert found.digest == PRESETS[name].digest
    assert found.parameters() == PRESETS[name].parameters()
    assert found.source == "mine.toml"
    # All numbers are in the file, also those that behaviours have by default.
    said = tomllib.loads(file.read_text(encoding="utf-8"))
    for number, value in PRESETS[name].parameters().items():
        behaviour, _, setting = number.partition(".")
        if behaviour != "options":
            table = said["terms"] if setting == "weight" else said["settings"][behaviour]
            assert table[behaviour if setting == "weight" else setting] == value
    assert said.get("most_acceleration") == PRESETS[name].most_acceleration


def test_a_model_takes_a_file_and_says_so(file):
    file.write_text(MINIMAL + "[settings.headway]\ntime = 0.6\n", encoding="utf-8")
    for given_as in (file, str(file)):
        model = PedestrianModel(corridor(), mobility_map=strider(), preset=given_as, rng=1)
        assert model.preset == "mine"
        sources = {name: each.source for name, each in model.parameters().items()}
        assert sources == {
            "options.most_acceleration": "mine.toml",
            "headway.weight": "mine.toml",
            "headway.time": "mine.toml",
            **dict.fromkeys(
                [f"headway.{x}" for x in ("distance", "width", "softness", "beyond")], "behaviour"
            ),
        }
        assert model.rules_used() == {
            "preset": f"mine, mine.toml, sha256 {read_preset(file).digest}"
        }


def test_provenance_is_kept(file):
    provenance = Provenance(
        date="2026-11-26",
        command="calibrate",
        data={"corridor one.txt": DIGEST},
        likelihoods={"gate": 2.25},
        figures={"flow, 1.2 m": 1.5},
    )
    write_preset(replace(PRESETS["paper"], provenance=provenance), file)
    assert read_preset(file).provenance == provenance
    assert "date = 2026-11-26\n" in file.read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("name = ", "is not TOML: "),
        (MINIMAL.replace("[terms]\nheadway = 1.5", ""), "has no terms, expected name, "),
        ("colour = 1\n" + MINIMAL, "unknown entry 'colour', expected name, "),
        ("tactic = []\n" + MINIMAL, "unknown entry 'tactic', did you mean 'tactics'?"),
        (MINIMAL.replace("[12]", "12"), "durations: got 12, expected a list"),
        (MINIMAL.replace("[12]", "[1.5]"), "durations[0]: got 1.5, expected a whole number"),
        (MINIMAL.replace("1.5", "nan"), "terms['headway']: got nan, expected a number"),
        (MINIMAL.replace("1.5", '"much"'), "terms['headway']: got 'much', expected a number"),
        (MINIMAL.replace("headway", "headwy"), "'headwy', did you mean 'headway'?"),
        (MINIMAL.replace('["visits"]', '["headway"]'), "tactics: 'headway' is no Tactic"),
        (MINIMAL.replace("nearest_exit", "visits"), "target_choice: 'visits' is no TargetChoice"),
        (MINIMAL + "[settings.headway]\ntime = 0\n", "headway: time 0, expected more than 0 s"),
        (MINIMAL + "[settings.headway]\ntim = 1\n", "no setting 'tim', did you mean 'time'"),
        (MINIMAL + "[settings.stepping]\nlength = 1\n", "'stepping' is no behaviour of the preset"),
        (MINIMAL + "[provenance]\ndate = 'today'\n", "date 'today', expected such as 2026"),
        (MINIMAL + "[provenance]\nday = 1\n", "provenance: unknown entry 'day', expected date, "),
        (MINIMAL + "[provenance.data]\na = 'b'\n", "provenance: data, a 'b', expected a sha256"),
        (MINIMAL + "[provenance.figures]\na = inf\n", "provenance: figures, a inf, expected a fin"),
    ],
)
def test_what_is_wrong_with_a_file_is_one_line(text, said, file):
    file.write_text(text, encoding="utf-8")
    with pytest.raises(ModelError) as no:
        read_preset(file)
    assert str(no.value).startswith(f"{file}: ")
    assert said in str(no.value)
    assert "\n" not in str(no.value)


def test_files_that_are_none(tmp_path):
    with pytest.raises(ModelError, match=r"none\.toml: no such file, expected a preset in TOML$"):
        read_preset(tmp_path / "none.toml")
    with pytest.raises(ModelError, match="cannot be read"):
        read_preset(tmp_path)
    large = tmp_path / "large.toml"
    large.write_bytes(b"#" * 1_000_001)
    with pytest.raises(ModelError, match="has 1000001 bytes, expected at most 1000000"):
        read_preset(large)
    (tmp_path / "bytes.toml").write_bytes(b"\xff")
    with pytest.raises(ModelError, match="is not TOML"):
        read_preset(tmp_path / "bytes.toml")
    with pytest.raises(ModelError, match=r"mine\.json: expected a name that ends with \.toml"):
        write_preset(PRESETS["paper"], tmp_path / "mine.json")
    with pytest.raises(ModelError, match=r"'defalt' is unknown, did you mean 'default'"):
        PedestrianModel(corridor(), preset="defalt", mobility_map=strider())
    with pytest.raises(ModelError, match="preset: got 3, expected a name, a TOML file or a Preset"):
        PedestrianModel(corridor(), preset=3, mobility_map=strider())


names = st.text(st.characters(codec="utf-8", exclude_categories=["Cc"]), min_size=1, max_size=20)
numbers = st.floats(allow_nan=False, allow_infinity=False)


@given(
    st.builds(
        Provenance,
        date=st.dates().map(lambda day: day.isoformat()),
        command=names,
        data=st.dictionaries(names, st.just(DIGEST), max_size=3),
        likelihoods=st.dictionaries(names, numbers, max_size=3),
        figures=st.dictionaries(names, numbers, max_size=3),
    ),
    names,
    st.floats(-1e9, 1e9),
)
def test_any_provenance_name_and_weight_are_read_as_written(provenance, name, weight):
    preset = replace(
        PRESETS["paper"],
        name=name,
        terms={**PRESETS["paper"].terms, "displacement": weight},
        provenance=provenance,
    )
    found = parse_preset(preset_text(preset), "file", "file")
    assert found.provenance == provenance
    assert (found.name, found.terms) == (preset.name, preset.terms)
    assert found.digest == preset.digest
