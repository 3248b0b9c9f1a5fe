"""The time series of a run, and their CSV files."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import solara

from mesa_mobility.dashboard.session.observer import WINDOW, Observer
from mesa_mobility.dashboard.widgets.text import heading

MOST_POINTS = 400
"""Points drawn of a curve; the file has all."""

COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#8c564b", "#999999")

GRID_LINES = {"lineStyle": {"color": "rgba(128, 128, 128, 0.3)"}}
"""Grey that is seen on light and on dark pages."""

dark = solara.reactive(False)
"""Whether the page is dark: each page has a value of its own."""

Columns = Mapping[str, Sequence[float]]


def csv_text(columns: Columns) -> str:
    """Columns of equal length as CSV with a line of names."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(columns)
    writer.writerows(zip(*columns.values(), strict=True))
    return out.getvalue()


def charts(observer: Observer) -> dict[str, tuple[str, Columns]]:
    """Title -> (unit, columns): ``elapsed_s`` and a curve for each other column."""
    series = observer.columns()
    time = series["elapsed"]
    return {
        "People inside": ("people", {"elapsed_s": time, "inside": series["inside"]}),
        f"Flow, mean of {WINDOW:g} s": (
            "1/s",
            {"elapsed_s": time, **{name: series[f"flow {name}"] for name in observer.openings}},
        ),
        "Mean speed": ("m/s", {"elapsed_s": time, "mean_speed": series["mean_speed"]}),
        "Density within 1 m of people": (
            "1/m\u00b2",
            {"elapsed_s": time, "mean": series["mean_density"], "greatest": series["max_density"]},
        ),
        "Share of the time in the fallback": (
            "%",
            {"elapsed_s": time, "so far": [100.0 * share for share in series["fallback_share"]]},
        ),
    }


def chart_option(
    columns: Columns, reference: Mapping[float, float] | None = None
) -> dict[str, Any]:
    """A line chart for ECharts.

    Args:
        columns: the time, and a curve for each other column.
        reference: published points, time (s) -> value.
    """
    (_, time), *curves = columns.items()
    stride = max(1, -(-len(time) // MOST_POINTS))
    # The newest entry is always drawn.
    picked = range((len(time) - 1) % stride, len(time), stride)
    drawn: list[dict[str, Any]] = [
        {
            "name": name,
            "type": "line",
            "showSymbol": False,
            "lineStyle": {"width": 1.5},
            "data": [[round(time[k], 3), round(values[k], 4)] for k in picked],
        }
        for name, values in curves
    ]
    if reference:
        drawn.append(
            {
                "name": "published",
                "type": "scatter",
                "symbolSize": 9,
                "data": [list(point) for point in reference.items()],
            }
        )
    return {
        "animation": False,
        "color": list(COLOURS),
        "legend": {
            "show": len(drawn) > 1,
            "top": 0,
            "type": "scroll",
            "itemWidth": 14,
        },
        "grid": {"left": 44, "right": 22, "top": 30 if len(drawn) > 1 else 12, "bottom": 24},
        "tooltip": {"trigger": "axis"},
        "xAxis": {
            "type": "value",
            "min": 0,
            "axisLabel": {"formatter": "{value} s", "hideOverlap": True},
            "splitLine": GRID_LINES,
        },
        "yAxis": {"type": "value", "min": 0, "splitLine": GRID_LINES},
        "series": drawn,
    }


def chart(
    title: str,
    option: dict[str, Any],
    height: int,
    clicked: Callable[[dict[str, Any]], None] | None = None,
) -> None:
    """A chart of ECharts below its title, which wraps where the chart is narrow.

    Args:
        title: above it, and the picture's name.
        option: what ECharts draws.
        height: pixels.
        clicked: called with what was clicked.
    """
    heading(3, title)
    solara.FigureEcharts(
        _coloured(option, "#d0d0d0" if dark.value else "#444444"),
        on_click=clicked,
        attributes={"style": f"height: {height}px", "role": "img", "aria-label": title},
        responsive=True,
    )


def _coloured(option: dict[str, Any], colour: str) -> dict[str, Any]:
    """The same chart with all its texts in one colour."""
    text = {"color": colour}
    for part in option.keys() & {"xAxis", "yAxis"}:
        own = option[part]
        label = {**own.get("axisLabel", {}), **text}
        option = {**option, part: {**own, "axisLabel": label, "nameTextStyle": text}}
    for part in option.keys() & {"legend", "visualMap"}:
        own = {**option[part], "textStyle": text, "pageTextStyle": text}
        option = {**option, part: own}
    return option


@solara.component
def Charts(
    observer: Observer, number: int, reference: Mapping[float, float] | None, name: str
) -> None:
    """All charts of a run, each with its file.

    Args:
        observer: what has been counted.
        number: changes when there is more of it.
        reference: published people inside, time (s) -> people.
        name: of the model, for the files' names.
    """
    with solara.ColumnsResponsive(12, medium=6, classes=["mm-charts"]):
        for number, (title, (unit, columns)) in enumerate(charts(observer).items()):
            points = reference if number == 0 else None
            with solara.Column(gap="0px"):
                chart(f"{title} ({unit})", chart_option(columns, points), 210)
                _Download(observer, title, name)


@solara.component
def _Download(observer: Observer, title: str, name: str) -> None:
    file = f"{name}_{title.partition(',')[0].lower().replace(' ', '_')}.csv"
    with solara.FileDownload(
        lambda: csv_text(charts(observer)[title][1]), file, mime_type="text/csv"
    ):
        solara.Button(
            "CSV",
            small=True,
            text=True,
            icon_name="mdi-download",
            attributes={"title": f"{title}, CSV"},
        )
