"""Keep Solara from any request to the internet, however the page is served."""

from __future__ import annotations

import solara.checks
import solara.server.settings


def keep_quiet() -> None:
    """Switch off Solara's telemetry and its check of the installation."""
    solara.server.settings.telemetry.mixpanel_enable = False

    def no_check() -> bool:
        return False

    # With the check, the first page on a machine would frame a page of Solara's site.
    solara.checks.should_perform_solara_check = no_check
