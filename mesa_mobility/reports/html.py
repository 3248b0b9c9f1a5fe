"""Pages of HTML that need no other file: headings, tables and pictures."""

from __future__ import annotations

import base64
import io
import os
from collections.abc import Mapping, Sequence
from html import escape
from typing import TYPE_CHECKING, Any

from mesa_mobility.errors import ResultsError
from mesa_mobility.files.atomic import replacing
from mesa_mobility.results.files import json_text

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_STYLE = """
body { font: 15px/1.5 system-ui, sans-serif; color: #222; max-width: 62rem; margin: 2rem auto;
  padding: 0 1rem; }
h1 { font-size: 1.7rem; } h2 { font-size: 1.2rem; margin-top: 2rem; }
table { border-collapse: collapse; font-size: 0.9rem; }
th, td { text-align: left; vertical-align: top; padding: 0.25rem 0.8rem 0.25rem 0;
  border-bottom: 1px solid #ddd; overflow-wrap: anywhere; }
th, td:first-child { overflow-wrap: break-word; }
img { max-width: 100%; } pre { background: #f5f5f5; padding: 0.8rem; white-space: pre-wrap; }
.pass { color: #1a7f37; } .fail { color: #b42318; font-weight: 600; }
@media print { body { margin: 0; max-width: none; font-size: 10pt; }
  h2, img, tr { break-inside: avoid; } h2 { break-after: avoid; } }
"""


class Page:
    """A page, part by part.

    Args:
        title: of the page.
    """

    def __init__(self, title: str) -> None:
        self._title = title
        self._parts: list[str] = []

    def heading(self, text: str) -> None:
        """A heading."""
        self._parts.append(f"<h2>{escape(text)}</h2>")

    def text(self, text: str) -> None:
        """A paragraph."""
        self._parts.append(f"<p>{escape(text)}</p>")

    def table(
        self, heading: str, columns: Sequence[str], rows: Sequence[Sequence[Any]], note: str = ""
    ) -> None:
        """A table below a heading.

        Args:
            heading: text, or nothing for none.
            columns: names of the columns.
            rows: their values.
            note: a paragraph below.
        """
        if heading:
            self.heading(heading)
        head = "".join(f"<th>{escape(name)}</th>" for name in columns)
        body = "".join(
            "<tr>" + "".join(f"<td>{_cell(value)}</td>" for value in row) + "</tr>" for row in rows
        )
        self._parts.append(f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>")
        if note:
            self.text(note)

    def picture(self, heading: str, png: bytes, caption: str = "") -> None:
        """A picture below a heading.

        Args:
            heading: text, or nothing for none.
            png: the picture.
            caption: a paragraph above; without one the heading describes the picture to those who
                cannot see it.
        """
        if heading:
            self.heading(heading)
        if caption:
            self.text(caption)
        content, said = base64.b64encode(png).decode(), escape(caption or heading or self._title)
        self._parts.append(f'<img alt="{said}" src="data:image/png;base64,{content}">')

    def json(self, heading: str, values: Mapping[str, Any]) -> None:
        """Values as JSON below a heading."""
        self.heading(heading)
        self._parts.append(f"<pre>{escape(json_text(values, indent=1))}</pre>")

    def write(self, path: str | os.PathLike[str]) -> None:
        """Write the page, whole or not at all.

        Raises:
            ResultsError: the page cannot be written.
        """
        title = escape(self._title)
        text = (
            f'<!doctype html>\n<html lang="en"><head><meta charset="utf-8"><title>{title}</title>'
            f"<style>{_STYLE}</style></head>\n<body><h1>{title}</h1>\n"
            + "\n".join(self._parts)
            + "\n</body></html>\n"
        )
        with replacing(path, ResultsError) as temporary:
            temporary.write_text(text, encoding="utf-8")


def picture(figure: Figure) -> bytes:
    """A figure of Matplotlib as PNG, without blank margins."""
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", bbox_inches="tight")
    return buffer.getvalue()


def _cell(value: Any) -> str:
    text = "-" if value is None else escape(str(value))
    marks = {"pass": "pass", "FAIL": "fail"}
    return f'<span class="{marks[text]}">{text}</span>' if text in marks else text
