"""Tabs, and rows of buttons of which one is down."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import solara

UNDRAWN = {"display": "none"}
"""Style of the first panel while another is chosen: its canvases stop drawing."""

UNSEEN = {
    "position": "absolute",
    "visibility": "hidden",
    "height": "0",
    "width": "100%",
    "overflow": "hidden",
}
"""Style of the others: ECharts warns of charts without a size that it makes a moment too late."""


@solara.component_vue("tabs.vue")
def _TabList(
    names: Mapping[str, str], chosen: str, label: str, event_choose: Callable[[str], None]
) -> None: ...


@solara.component
def Tabs(
    label: str, names: Mapping[str, str], panels: Mapping[str, Callable[[], solara.Element]]
) -> None:
    """A list of tabs and their panels; a panel is made when its tab is chosen first, and kept.

    Args:
        label: what the tabs are of.
        names: name of each tab, and what it is for.
        panels: by name, what makes the panel's element.
    """
    chosen, choose = solara.use_state(next(iter(names)))
    opened = solara.use_ref({chosen})

    def turn(name: str) -> None:
        opened.current = opened.current | {name}
        choose(name)

    _TabList(names=names, chosen=chosen, label=label, event_choose=turn)
    for number, name in enumerate(names):
        with solara.Div(
            classes=["mm-panel"],
            style={} if name == chosen else UNDRAWN if number == 0 else UNSEEN,
            attributes={
                "role": "tabpanel",
                "id": f"mm-panel-{number}",
                "aria-labelledby": f"mm-tab-{number}",
            },
        ).key(name):
            if name in opened.current:
                panels[name]()


@solara.component
def OneOf(label: str, names: Mapping[str, str], chosen: str, choose: Callable[[str], None]) -> None:
    """Buttons of which one is down.

    Args:
        label: what they choose.
        names: name of each, and what it shows.
        chosen: the one that is down.
        choose: called with the name of another one.
    """
    with solara.Div(classes=["mm-one-of"], attributes={"role": "group", "aria-label": label}):
        for name, about in names.items():
            down = name == chosen
            solara.Button(
                name,
                small=True,
                on_click=lambda name=name: choose(name),
                classes=["mm-down"] if down else [],
                attributes={"title": about, "aria-pressed": str(down).lower()},
            )
