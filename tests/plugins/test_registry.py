import pytest

from mesa_mobility.errors import ModelError
from mesa_mobility.plugins import registry
from tests.commands.conftest import install, plugins

__all__ = ["install", "plugins"]

SHIPPED_MODELS = {
    "straight_walk",
    "open_space",
    "doorway",
    "auditorium",
    "mixed_evacuation",
    "office_tower",
    "scenario",
}
SHIPPED_BEHAVIORS = {
    "target_distance",
    "facing_deviation",
    "displacement",
    "interference",
    "preferred_speed",
    "preferred_velocity",
    "headway",
    "right_of_way",
    "stepping",
    "room_ahead",
    "velocity_change",
    "sideways",
}


def test_what_ships_is_registered_like_any_plug_in():
    assert set(registry.models()) >= SHIPPED_MODELS
    assert set(registry.behaviors()) >= SHIPPED_BEHAVIORS
    assert registry.models()["doorway"].package.startswith("mesa-mobility ")


@pytest.mark.usefixtures("plugins")
def test_a_plug_in_is_found_and_loaded():
    plugin = registry.models()["corridor"]
    assert (plugin.target, plugin.package) == ("corridor_plugin:Corridor", "corridors 1.2")
    assert registry.load_model("corridor").__name__ == "Corridor"


@pytest.mark.usefixtures("plugins")
def test_what_is_installed_is_looked_through_once_a_group(monkeypatch):
    looked, entry_points = [], registry.entry_points
    monkeypatch.setattr(
        registry, "entry_points", lambda group: looked.append(group) or entry_points(group=group)
    )
    assert registry.load_model("corridor") is registry.load_model("corridor")
    assert registry.load_model("doorway").__name__ == "Doorway"
    assert looked == [registry.MODELS]
    for _ in range(2):  # what is not found may have been installed since
        with pytest.raises(ModelError, match="unknown model 'nowhere'"):
            registry.load_model("nowhere")
    assert looked == [registry.MODELS] * 3


@pytest.mark.usefixtures("plugins")
def test_names_come_in_alphabetical_order():
    names = list(registry.models())
    assert names == sorted(names)
    assert {"absent", "corridor", "doorway"} <= set(names)


@pytest.mark.usefixtures("plugins")
@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("absent", "ModuleNotFoundError: No module named 'no_such_module'"),
        ("nameless", "AttributeError"),
        ("number", "is not a class"),
    ],
)
def test_a_broken_plug_in_is_named_with_its_package(name, reason):
    with pytest.raises(ModelError, match=rf"model {name} .*corridors 1\.2") as caught:
        registry.load_model(name)
    assert reason in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.usefixtures("plugins")
def test_a_plug_in_that_fails_in_several_lines_gives_one(tmp_path):
    site = tmp_path / "site" / "corridors"
    (site / "no_such_module.py").write_text("raise RuntimeError('first line\\nsecond line')\n")
    with pytest.raises(ModelError, match="RuntimeError: first line second line"):
        registry.load_behavior("broken_term")


def test_an_unknown_name_lists_what_there_is_and_guesses():
    with pytest.raises(
        ModelError, match="unknown model 'dorway', did you mean 'doorway'"
    ) as caught:
        registry.load_model("dorway")
    for name in SHIPPED_MODELS:
        assert name in str(caught.value)
    with pytest.raises(ModelError, match="unknown behavior 'zzz'; installed: "):
        registry.load_behavior("zzz")


def test_two_packages_with_one_name_spoil_only_that_name(install):
    install("left", "[mesa_mobility.models]\npier = left:Pier\n")
    install("right", "[mesa_mobility.models]\npier = right:Pier\nquay = right:Quay\n")
    assert {"pier", "quay"} <= set(registry.models())
    with pytest.raises(ModelError, match=r"pier is offered both by left 1\.2 and by right 1\.2"):
        registry.load_model("pier")
