"""Makes the model that a command names, and lists what is needed to repeat the run."""

from __future__ import annotations

import platform
import secrets
from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any

import typer

from mesa_mobility.commands.console import some_path
from mesa_mobility.commands.models.behaviors import use_behaviors
from mesa_mobility.errors import ModelError

MODEL_HELP = (
    "Name of an installed model (`mesa-mobility models` lists them), FILE.py, FILE.py:NAME, or "
    "module:NAME."
)
PLAN_MODEL, SCENARIO_MODEL = "floor_plan", "scenario"
"""Models of a file of a floor plan, and of one with people."""
ModelName = Annotated[
    str,
    typer.Argument(
        metavar="MODEL|FILE",
        help=MODEL_HELP + " Or the file of a floor plan, a building or a scenario.",
    ),
]
PresetName = Annotated[
    str | None,
    typer.Option(
        "--preset",
        metavar="NAME|FILE",
        help="default, paper or a TOML file. By default the model's own.",
    ),
]
Settings = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="NAME=VALUE",
        help="A parameter of the model, or a number of a behaviour (headway.time=0.6); repeatable.",
    ),
]
Numbers = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="NAME=VALUE",
        help="A number of a behaviour, such as headway.time=0.6; repeatable. "
        "`mesa-mobility preset` lists them.",
    ),
]


@dataclass(frozen=True)
class ModelOptions:
    """Options of commands that make a model."""

    seed: Annotated[
        int | None,
        typer.Option(
            min=0, help="Seed, which makes a run repeatable. By default one is drawn and printed."
        ),
    ] = None
    settings: Settings = None
    behaviors: Annotated[
        list[str] | None,
        typer.Option(
            "--behavior",
            metavar="NAME[=WEIGHT]",
            help="An installed behaviour to use besides the model's own; repeatable. "
            "`mesa-mobility behaviors NAME` lists its settings.",
        ),
    ] = None
    preset: PresetName = None
    map_file: Annotated[
        Path | None,
        typer.Option(
            "--map",
            help="Mobility map instead of the shipped one.",
            parser=some_path,
            metavar="PATH",
        ),
    ] = None

    def with_seed(self) -> ModelOptions:
        """These options with a seed, which is drawn if none was given."""
        return replace(self, seed=secrets.randbelow(2**31)) if self.seed is None else self


def model_of_file(text: str, options: ModelOptions) -> tuple[str, ModelOptions]:
    """The name of a model and its options; of a file of a plan those of the model that runs it.

    Args:
        text: what the user calls the model, or the file.
        options: of the command.

    Raises:
        FloorPlanError: a folder or a zip that is neither a plan nor a scenario.
    """
    from mesa_mobility.crowd.model_files import is_model_file
    from mesa_mobility.plugins import registry

    path = Path(text)
    # Formats are looked for only where there is a file that is no model. A folder may have the name
    # of a model, such as that of its run.
    if not path.exists() or not (path.is_dir() or path.suffix) or is_model_file(text):
        return text, options
    if path.is_dir() and text in registry.models():
        return text, options
    from mesa_mobility.floorplan.formats.plan_format import PLANS
    from mesa_mobility.floorplan.scenario import has_people
    from mesa_mobility.plugins.formats import READ

    if path.is_file() and path.suffix.lower() not in PLANS.suffixes(READ):
        return text, options
    settings = options.settings or []
    filled = any(each.startswith("fill=") for each in settings)
    name = SCENARIO_MODEL if not filled and has_people(path) else PLAN_MODEL
    return name, replace(options, settings=[f"plan={text}", *settings])


def create_model(
    kind: type,
    name: str,
    options: ModelOptions,
    *,
    record: bool | str = False,
    buildings: bool = False,
    **keywords: Any,
) -> tuple[Any, dict[str, Any]]:
    """The model with its behaviours and numbers, and its own parameters with their values.

    Args:
        kind: class of the model.
        name: what the user calls the model.
        options: of the command. Settings with a dot in the name are numbers of behaviours.
        record: what the model records. A `PedestrianModel` records it even if its constructor does
            not take ``record``.
        buildings: whether the model may have a building of several levels.
        keywords: further arguments of the constructor.

    Raises:
        ModelError: a parameter that the constructor does not take, an unknown behaviour or number,
            a value that is refused, or a building of several levels where none is expected.
    """
    from mesa_mobility import PedestrianModel
    from mesa_mobility.crowd.presets.given import Given
    from mesa_mobility.crowd.presets.naming import COMMAND_LINE
    from mesa_mobility.plugins.parameters import NOT_SETTABLE, OWN_OPTION, chosen, parameters

    own, numbers = split_settings(options.settings or [])
    keywords = {**chosen(kind, name, own), **keywords, "rng": options.seed}
    if options.map_file is not None:
        keywords["mobility_map"] = str(options.map_file)
    if options.preset is not None:
        keywords["preset"] = options.preset
    taken = parameters(kind)
    # A model of one's own need not mention it.
    recorded_later = record and "record" not in taken and issubclass(kind, PedestrianModel)
    if record and not recorded_later:
        keywords["record"] = record
    missing = [key for key in keywords if key not in taken]
    if missing:
        asked = [f"{key} ({OWN_OPTION[key]})" if key in OWN_OPTION else key for key in missing]
        raise ModelError(f"model {name}: its constructor does not take {', '.join(asked)}")
    given = {
        key: keywords.get(key, each.default)
        for key, each in taken.items()
        if key not in NOT_SETTABLE
    }
    try:
        with Given(None, numbers, COMMAND_LINE).followed():
            model = kind(**keywords)
    except ModelError as error:
        parameter, colon, rest = str(error).partition(":")
        if not colon or parameter not in OWN_OPTION or parameter not in keywords:
            raise
        # In the words of the user, who has typed no parameter's name.
        raise ModelError(f"{OWN_OPTION[parameter]}:{rest}") from error
    if not buildings and getattr(model, "building", None) is not None:
        raise ModelError(
            f"model {name}: has a building of {len(model.building.levels)} levels, expected one "
            "floor plan (`mesa-mobility run`, `serve` and Python run buildings)"
        )
    if recorded_later:
        model.start_recording(record)
    use_behaviors(model, options.behaviors or [])
    # Only now are all behaviours there that the numbers may be of.
    if numbers:
        if not isinstance(model, PedestrianModel):
            raise ModelError(
                f"model {name}: has no behaviours, expected no --set {next(iter(numbers))}"
            )
        model.set_parameters(numbers, COMMAND_LINE)
    return model, given


def split_settings(settings: Iterable[str]) -> tuple[list[str], dict[str, str]]:
    """Settings of a model, and texts of numbers of behaviours by name, from texts NAME=VALUE.

    Raises:
        ModelError: a number is given twice, or without a value.
    """
    own: list[str] = []
    numbers: dict[str, str] = {}
    for setting in settings:
        name, equals, value = (part.strip() for part in setting.partition("="))
        if "." not in name:
            own.append(setting)
            continue
        if not equals:
            raise ModelError(f"--set {setting}: expected NAME=VALUE")
        if name in numbers:
            raise ModelError(f"--set {setting}: {name} is set twice")
        numbers[name] = value
    return own, numbers


def origin_of(given: dict[str, Any], simulation: Any) -> dict[str, Any]:
    """What it takes to repeat a run, besides model, preset and seed."""
    from importlib.metadata import version

    from mesa_mobility._version import __version__
    from mesa_mobility.reports.inputs import map_files

    plain = (bool, int, float, str, type(None))
    return {
        "parameters": {
            key: value if isinstance(value, plain) else str(value) for key, value in given.items()
        },
        "maps": map_files(simulation),
        **_rules_of(simulation),
        "mesa_mobility": __version__,
        "versions": {
            "python": platform.python_version(),
            **{name: version(name) for name in ("mesa", "numpy", "numba", "scipy", "shapely")},
        },
    }


def _rules_of(simulation: Any) -> dict[str, Any]:
    """The digest of a model's preset, and the numbers that the command line has set."""
    from mesa_mobility import PedestrianModel
    from mesa_mobility.crowd.presets.naming import COMMAND_LINE

    if not isinstance(simulation, PedestrianModel):
        return {}
    changed = {
        name: str(each.value)
        for name, each in simulation.parameters().items()
        if each.source == COMMAND_LINE
    }
    return {"preset_sha256": simulation.numbers.base.digest, "set": changed}
