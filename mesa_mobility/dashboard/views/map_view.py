"""A mobility map: its clusters, coverage and sources."""

from __future__ import annotations

from html import escape
from typing import Any

import numpy as np
import solara

from mesa_mobility import MobilityMap
from mesa_mobility.dashboard.views import map_data
from mesa_mobility.dashboard.views.canvases import canvas_component
from mesa_mobility.dashboard.views.charts import GRID_LINES, chart
from mesa_mobility.dashboard.widgets.fields import Switch, TextField
from mesa_mobility.dashboard.widgets.text import heading


@canvas_component("cluster_view.vue")
def ClusterCanvas(cluster: dict[str, Any]) -> None:
    """One cluster's options and mean pose; ``cluster`` is what ``map_data.cluster`` makes."""


@solara.component
def MapView(mobility_map: MobilityMap) -> None:
    """All of one map."""
    number, pick = solara.use_state(mobility_map.standing)
    whole, set_whole = solara.use_state(True)
    cluster = solara.use_memo(
        lambda: map_data.cluster(mobility_map, number), [mobility_map, number]
    )
    rows = mobility_map.options_of(number)
    part = slice(None) if whole else slice(rows.start, rows.stop)
    clusters = solara.use_memo(
        lambda: clusters_option(mobility_map, number), [mobility_map, number]
    )
    covered = solara.use_memo(
        lambda: coverage_option(mobility_map, part), [mobility_map, number, whole]
    )

    error, set_error = solara.use_state("")

    def clicked(event: dict[str, Any]) -> None:
        if event.get("data"):
            pick(int(event["data"]["value"][3]))

    def typed(text: str) -> None:
        most = mobility_map.n_clusters - 1
        known = text.isdecimal() and int(text) <= most
        set_error("" if known else f"cluster: got {text!r}, expected a number from 0 to {most}")
        if known:
            pick(int(text))

    with solara.Div(classes=["mm-map"]):
        heading(2, f"Mobility map: {mobility_map.info()['pedestrian_type']}")
        _Facts(mobility_map)
        with solara.Div(classes=["mm-halves"]):
            with solara.Div(classes=["mm-left"]):
                chart(
                    "Clusters: a click chooses one (area: recorded poses)", clusters, 380, clicked
                )
                TextField(
                    f"cluster, 0 to {mobility_map.n_clusters - 1}",
                    str(number),
                    typed,
                    error,
                    "Poses that are alike; the options and the mean pose of one are shown",
                )
                about = "Speeds and turns of the options of all clusters, or of the one shown"
                Switch("coverage of the whole map", whole, set_whole, about, quiet=True)
                chart("Coverage: options by speed and turning", covered, 340)
            with solara.Div(classes=["mm-right"]):
                ClusterCanvas(cluster=cluster)
        _Provenance(mobility_map)


def clusters_option(mobility_map: MobilityMap, chosen: int) -> dict[str, Any]:
    """A scatter chart for ECharts: speed and options of each cluster, the area its poses."""
    columns = map_data.clusters(mobility_map)
    sizes = 4.0 + 22.0 * np.sqrt(np.array(columns["poses"]) / max(columns["poses"]))
    points: list[dict[str, Any]] = [
        {"value": [speed, options, poses, k], "symbolSize": round(float(sizes[k]), 1)}
        for k, (speed, options, poses) in enumerate(zip(*columns.values(), strict=True))
    ]
    ring = {**points[chosen], "symbolSize": points[chosen]["symbolSize"] + 6}
    return {
        "animation": False,
        "grid": {"left": 68, "right": 16, "top": 12, "bottom": 40},
        "tooltip": {"formatter": "cluster {@[3]}: {@[1]} options, {@[2]} poses, {@[0]} m/s"},
        "xAxis": {
            "type": "value",
            "name": "mean speed (m/s)",
            "nameLocation": "middle",
            "nameGap": 24,
            "splitLine": GRID_LINES,
        },
        "yAxis": {
            "type": "log",
            "name": "options",
            "nameLocation": "middle",
            "nameGap": 48,
            "splitLine": GRID_LINES,
        },
        "series": [
            {"type": "scatter", "data": points, "itemStyle": {"color": "#0072b2", "opacity": 0.6}},
            {
                "type": "scatter",
                "data": [ring],
                "silent": True,
                "z": 10,
                "itemStyle": {
                    "color": "transparent",
                    "borderColor": "#e6007e",
                    "borderWidth": 2.5,
                },
            },
        ],
    }


def coverage_option(mobility_map: MobilityMap, rows: slice) -> dict[str, Any]:
    """A heat map for ECharts: options by speed and turning."""
    cells = map_data.coverage(mobility_map, rows)
    speeds = [
        f"{k * map_data.SPEED_STEP:.1f}"
        for k in range(round(map_data.FASTEST / map_data.SPEED_STEP))
    ]
    turns = [
        f"{t:.0f}" for t in np.arange(-map_data.MOST_TURN, map_data.MOST_TURN, map_data.TURN_STEP)
    ]
    data = [
        [
            round(speed / map_data.SPEED_STEP),
            round((turn + map_data.MOST_TURN) / map_data.TURN_STEP),
            round(float(np.log10(count)), 3),
            count,
        ]
        for speed, turn, count in cells
    ]
    most = max((count for *_, count in cells), default=1)
    return {
        "animation": False,
        "grid": {"left": 60, "right": 90, "top": 12, "bottom": 48},
        "tooltip": {"formatter": "{@[3]} options"},
        "xAxis": {
            "type": "category",
            "data": speeds,
            "name": "speed from (m/s)",
            "nameLocation": "middle",
            "nameGap": 24,
        },
        "yAxis": {
            "type": "category",
            "data": turns,
            "name": "turn from (degrees, left positive)",
            "nameLocation": "middle",
            "nameGap": 40,
        },
        "visualMap": {
            "min": 0,
            "max": max((row[2] for row in data), default=1),
            "dimension": 2,
            "right": 0,
            "top": "middle",
            "text": [f"{most} options", "1 option"],
            "inRange": {"color": ["#fde725", "#5ec962", "#21918c", "#3b528b", "#440154"]},
        },
        "series": [{"type": "heatmap", "data": data}],
    }


@solara.component
def _Facts(mobility_map: MobilityMap) -> None:
    info = mobility_map.info()
    build = info.get("build", {})
    facts = {
        "Pedestrian type": info["pedestrian_type"],
        "Clusters": f"{info['clusters']} ({build.get('clusters_stopped_by', 'unknown')})",
        "Options": f"{info['options']}: "
        + ", ".join(f"{n} of {f} frames" for f, n in info["options_by_frames"].items()),
        "Options a cluster": "{min} to {max}, median {median:g}".format(
            **info["options_per_cluster"]
        ),
        "Motion graph": _graph(build),
        "Built by": info.get("command", "unknown"),
    }
    rows = "".join(
        f"<tr><th>{escape(name)}</th><td>{escape(str(value))}</td></tr>"
        for name, value in facts.items()
    )
    solara.HTML("table", rows, classes=["mm-table"])


def _graph(build: dict[str, Any]) -> str:
    components = build.get("largest_components")
    if not components:
        return "unknown"
    return (
        f"{build.get('poses')} poses, {build.get('transitions')} transitions; largest strongly "
        f"connected components: {', '.join(map(str, components))} poses"
    )


@solara.component
def _Provenance(mobility_map: MobilityMap) -> None:
    clips = mobility_map.metadata.get("provenance", [])
    for line in mobility_map.metadata.get("acknowledgements", []):
        solara.Text(line, style={"display": "block", "font-size": "13px"})
    with solara.v.Html(tag="details", class_="mm-details"):
        solara.v.Html(
            tag="summary",
            children=[f"Recordings and licences: {len(clips)} clips"],
            attributes={"title": "The recordings behind the map, and their licences"},
        )
        columns = ("clip", "subject", "description", "poses", "mirrored", "licence", "source")
        head = "".join(f"<th>{name}</th>" for name in columns)
        rows = "".join(
            "<tr>" + "".join(f"<td>{escape(str(clip.get(c, '')))}</td>" for c in columns) + "</tr>"
            for clip in clips
        )
        with solara.Div(style={"max-height": "420px", "overflow": "auto"}):
            solara.HTML("table", f"<tr>{head}</tr>{rows}", classes=["mm-table"])
