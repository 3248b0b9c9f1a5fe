"""Tabs, and rows of buttons of which one is down."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import solara


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
            style={"display": "block" if name == chosen else "none"},
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
