"""Keep Solara from any request to the internet, however the page is served."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import solara.checks
import solara.server.settings
from solara.components.echarts import EchartsWidget
from solara.widgets import Navigator


def keep_quiet() -> None:
    """Switch off Solara's telemetry, its check of the installation, and warnings of its scripts."""
    solara.server.settings.telemetry.mixpanel_enable = False

    def no_check() -> bool:
        return False

    # With the check, the first page on a machine would frame a page of Solara's site.
    solara.checks.should_perform_solara_check = no_check
    # Browsers warned on each page of a misspelt word.
    _mend(Navigator, {"modules.export ": "module.exports "})
    # ECharts warned of charts that it made in a tab that was no longer shown: they have no size.
    _mend(
        EchartsWidget,
        {
            "create() {": "create() { if (!this.$refs.echarts?.clientWidth) return;",
            "this.chart.resize();\n      }": (
                "this.chart.resize();\n      } else if (this.echarts) { this.create(); }"
            ),
        },
    )


def _mend(widget: type[Any], changes: Mapping[str, str]) -> None:
    """Replace some of the script of one of Solara's widgets."""
    begin, file = widget.__init__, widget.template_file
    if not file:
        return
    path = Path(file) if isinstance(file, str) else Path(file[0]).parent / file[1]
    text = path.read_text(encoding="utf-8")
    for before, after in changes.items():
        text = text.replace(before, after)

    def with_text(self: Any, *arguments: Any, **keywords: Any) -> None:
        begin(self, *arguments, **{"template": text, **keywords})

    widget.__init__ = with_text
    widget.template_file = None
