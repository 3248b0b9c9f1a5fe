"""Output of behaviours is checked before it is used: one error, and nobody moves."""

from dataclasses import replace

import numpy as np
import pytest
from mesa_mobility.behaviors import NearestExit, QuickestExit
from mesa_mobility.behaviors.exits.random_utility import RandomUtility

from mesa_mobility import CompiledTerm, CostTerm, PedestrianType, SpeedRule, option_kernel
from mesa_mobility.distributions import Distribution
from mesa_mobility.errors import ModelError
from tests.fixtures.maps import shipped_map, strider
from tests.fixtures.scenes import advance, corridor, model_of, put


class Changed(NearestExit):
    """The nearest exit, with some of its output changed."""

    def __init__(self, **changed) -> None:
        super().__init__()
        self.changed: dict = changed
        self.on = False

    def targets(self, deciding):
        found = super().targets(deciding)
        return replace(found, **self.changed) if self.on else found


class Silent(NearestExit):
    def targets(self, deciding):
        return None


def refuses(model, message: str, choice: Changed | None = None) -> None:
    person = put(model, 2.0, 2.0) if not model.inside else model.agents[0]
    if choice is not None:
        choice.on = True
    before = model.frame, person.position.tolist()
    with pytest.raises(ModelError, match=message) as caught:
        advance(model, 3)
    assert "\n" not in str(caught.value)
    assert (model.frame, person.position.tolist()) == before


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"corners": [[-7, -1]]}, "'nearest_exit': gave other corners, expected two of the site"),
        ({"corners": [[2**40, 2**40]]}, "gave other corners"),
        ({"corners": [[-1, 2**40]]}, "gave other corners"),
        ({"corners": [[-(2**63), -1]]}, "gave other corners"),
        ({"corners": [[np.nan, np.nan]]}, "gave corners of type float64, expected whole numbers"),
        ({"corners": [[0.5, 1.0]]}, "gave corners of type float64"),
        ({"corners": [["a", "b"]]}, "gave corners of type <U1"),
        ({"corners": [[0, 1], [2]]}, "gave corners that are no array"),
        ({"corners": [0, 1]}, r"gave corners of shape \(2,\), expected \(1, 2\)"),
        ({"gates": [-2]}, "gave other gates, expected -1 or numbers of openings, 0 to 0"),
        ({"gates": [1]}, "gave other gates"),
        ({"gates": [np.nan]}, "gave gates of type float64"),
        ({"gates": None}, r"gave gates of shape \(\)"),
        ({"points": [[np.nan, 2.0]]}, "gave other points, expected finite ones"),
        ({"points": [[np.inf, 2.0]]}, "gave other points"),
        ({"points": [[1e300, 2.0]]}, "gave other points"),
        ({"points": [[3.0, 2.0, 1.0]]}, r"gave points of shape \(1, 3\), expected \(1, 2\)"),
        ({"points": [["a", "b"]]}, "gave points of type"),
        ({"distances": [np.nan]}, "gave other distances, expected metres, or inf"),
        ({"distances": [-np.inf]}, "gave other distances"),
        ({"distances": [1.0, 2.0]}, r"gave distances of shape \(2,\)"),
        ({"distances": [1.0 + 2.0j]}, "gave distances of type complex128"),
    ],
)
def test_targets(changed, message):
    choice = Changed(**changed)
    refuses(model_of(corridor(), strider(), target_choice=choice), message, choice)


def test_targets_that_are_none():
    with pytest.raises(ModelError, match="gave NoneType, expected Targets"):
        put(model_of(corridor(), strider(), target_choice=Silent()), 2.0, 2.0)


class Given(SpeedRule):
    name = "given"

    def __init__(self, speeds) -> None:
        self._speeds = speeds
        self.on = False

    def speeds(self, deciding, speeds):
        return self._speeds if self.on else speeds


@pytest.mark.parametrize(
    ("speeds", "message"),
    [
        ([np.nan], "'given': gave a speed of nan m/s, expected 0 to 100"),
        ([-1.0], "gave a speed of -1.0"),
        ([1e300], "gave a speed of 1e\\+300"),
        ([1.0, 1.0], r"gave speeds of shape \(2,\), expected \(1,\)"),
        (None, r"gave speeds of shape \(\)"),
        (["fast"], "gave speeds of type"),
    ],
)
def test_speeds(speeds, message):
    model = model_of(corridor(), strider())
    pace = Given(speeds)
    model.speed_rules.append(pace)
    put(model, 2.0, 2.0)
    pace.on = True
    refuses(model, message)


class Costs(CostTerm):
    name = "costs"

    def __init__(self, value) -> None:
        super().__init__()
        self._value = value

    def cost(self, candidates):
        return self._value


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("costs", "message"),
    [
        (
            [1.0, 2.0, 3.0, np.nan],
            "'costs': gave a cost of nan for option 3 of 4, expected finite numbers",
        ),
        ([1.0, 2.0, 3.0, np.inf], "gave a cost of inf"),
        ([1.0], r"gave costs of shape \(1,\), expected \(4,\)"),
        (None, r"gave costs of shape \(\)"),
        (["a"] * 4, "gave costs of type"),
    ],
)
def test_costs(costs, message, whole):
    model = model_of(corridor(), strider(), preset=whole)
    put(model, 2.0, 2.0)
    model.terms.append(Costs(costs))
    refuses(model, message)


@option_kernel
def scaled(option, p):
    return p.number * option.speed


class Scaled(CompiledTerm):
    name = "scaled"
    kernel = scaled

    def __init__(self, number) -> None:
        super().__init__()
        self.number = number


@pytest.mark.parametrize(
    ("number", "message"),
    [
        ("a", "'scaled': gave p.number of type"),
        ((1.0, 2.0), r"'scaled': gave p.number of shape \(2,\), expected \(\)"),
        (np.nan, "not a number.*scaled"),
    ],
)
def test_numbers_of_kernels(number, message):
    model = model_of(corridor(), strider())
    put(model, 2.0, 2.0)
    model.terms.append(Scaled(number))
    refuses(model, message)


class Drawn(Distribution):
    def __init__(self, values) -> None:
        self._values = values

    def quantile(self, share):
        return self._values


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ([1.0], r"Drawn: gave draws of shape \(1,\), expected \(2,\)"),
        (1.0, r"Drawn: gave draws of shape \(\)"),
        ([1.0, np.nan], "expected 2 finite numbers"),
        (["a", "b"], "Drawn: gave draws of type"),
    ],
)
@pytest.mark.parametrize("name", ["preferred_speeds", "pre_movement"])
def test_draws(name, values, message):
    model = model_of(corridor(), strider())
    with pytest.raises(ModelError, match=message):
        model.add_pedestrians([(2.0, 1.0), (2.0, 3.0)], **{name: Drawn(values)})
    assert model.inside == 0


def test_draws_of_a_type():
    kind = PedestrianType(mobility_map=strider(), preferred_speed=Drawn([1.0, 2.0, 3.0]))
    model = type(model_of(corridor(), strider()))(corridor(), pedestrian_types=[kind])
    with pytest.raises(ModelError, match="expected 2 finite numbers"):
        model.add_pedestrians([(2.0, 1.0), (2.0, 3.0)])


@pytest.mark.parametrize("speed", [0.0, -1.0, np.nan, 1e300])
def test_speeds_that_nobody_has(speed):
    with pytest.raises(ModelError, match="preferred_speeds"):
        put(model_of(corridor(), strider()), 2.0, 2.0, preferred_speeds=speed)


class Chosen(QuickestExit):
    name = "chosen"

    def __init__(self, exits) -> None:
        super().__init__()
        self._exits = exits

    def choose(self, choosing):
        return self._exits


@pytest.mark.parametrize("exits", [[5], [-7], [0.5], [np.nan], [0, 0], None])
def test_exits_chosen(exits):
    model = model_of(corridor(), shipped_map(), target_choice=Chosen(exits))
    with pytest.raises(
        ModelError, match=r"'chosen': chose exits of shape .* numbers of exits, 0 to 0"
    ):
        put(model, 2.0, 2.0)


class Bonus(RandomUtility):
    name = "bonus"

    def __init__(self, value) -> None:
        super().__init__()
        self._value = value

    def bonus(self, choosing):
        return self._value


@pytest.mark.parametrize("value", [[[np.nan]], [[np.inf]], [1.0, 2.0]])
def test_bonuses(value):
    model = model_of(corridor(), shipped_map(), target_choice=Bonus(value))
    with pytest.raises(ModelError, match=r"'bonus': gave a bonus of shape .* finite numbers"):
        put(model, 2.0, 2.0)
