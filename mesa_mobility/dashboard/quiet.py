"""Keep Solara from any request to the internet, however the page is served."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import solara.checks
import solara.server.settings
from solara.widgets import Navigator


def keep_quiet() -> None:
    """Switch off Solara's telemetry, its check of the installation, and a warning on each page."""
    solara.server.settings.telemetry.mixpanel_enable = False

    def no_check() -> bool:
        return False

    # With the check, the first page on a machine would frame a page of Solara's site.
    solara.checks.should_perform_solara_check = no_check
    _mend_navigator()


def _mend_navigator() -> None:
    """Spell a word of Solara's script right: browsers warned on each page of ``modules.export``."""
    begin, file = Navigator.__init__, Navigator.template_file
    if not file:
        return
    text = Path(file).read_text(encoding="utf-8").replace("modules.export ", "module.exports ")

    def with_text(self: Navigator, *arguments: Any, **keywords: Any) -> None:
        begin(self, *arguments, **{"template": text, **keywords})

    Navigator.__init__ = with_text  # type: ignore[assignment, method-assign]
    Navigator.template_file = None  # type: ignore[assignment]
