"""The crowd view for Mesa's own dashboard."""

from __future__ import annotations

from collections.abc import Callable

import solara
from mesa.visualization.utils import update_counter

from mesa_mobility import PedestrianModel
from mesa_mobility.dashboard.quiet import keep_quiet
from mesa_mobility.dashboard.session import serialization
from mesa_mobility.dashboard.session.colouring import colouring_named
from mesa_mobility.dashboard.session.observer import Observer
from mesa_mobility.dashboard.views.crowd_view import CrowdCanvas

keep_quiet()


def make_crowd_view(
    colour_by: str = "speed", height: str = "62vh"
) -> Callable[[PedestrianModel], solara.Element]:
    """The crowd view as a component for Mesa's ``SolaraViz``.

    ``SolaraViz(model, components=[make_crowd_view()])`` shows it beside any other component.

    Args:
        colour_by: "speed", "type", "waiting time", "density" or a field of the model's people.
        height: of the canvas, as CSS says it.

    An unknown ``colour_by`` raises ModelError when the view is drawn.
    """

    @solara.component
    def CrowdView(model: PedestrianModel) -> None:
        update_counter.get()  # Mesa's sign that the model has stepped
        observer = solara.use_memo(lambda: Observer(model), [model])
        observer.after_step()
        plan = model.floor_plan
        floor = solara.use_memo(
            lambda: serialization.floor(plan, building=model.building), [plan, plan.version]
        )
        colouring = colouring_named(colour_by, model)
        shown = solara.use_ref((observer, -1))
        since = shown.current[1] if shown.current[0] is observer else -1
        frame = serialization.frame(
            model, colouring, observer, run=id(model), number=model.frame, since=since
        )
        shown.current = observer, model.frame
        CrowdCanvas(frame=frame, floor=floor, height=height)

    return CrowdView
