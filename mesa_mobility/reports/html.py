"""Report pages in HTML that need no other file: numbered sections, tables and pictures."""

from __future__ import annotations

import base64
import io
import os
import re
import shlex
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING, Any

from mesa_mobility.errors import ResultsError
from mesa_mobility.files.atomic import replacing
from mesa_mobility.reports.style import STYLE
from mesa_mobility.results.files import json_text

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_MARKS = {"pass": "pass", "FAIL": "fail"}

_SHORT = 10
"""Rows of a table that is not broken over two sheets of paper."""

_UNIT = re.compile(r"\([^()]*(?:\([^()]*\)[^()]*)*\)$")
"""A unit in brackets at the end of a heading; a unit itself may have brackets."""

_LONG = re.compile(r"[0-9a-f]{40}|\S{60}")
"""Texts that may be broken anywhere, such as digests."""

_TO_SIGN = ("Prepared by", "Checked by", "Approved by")


@dataclass(frozen=True)
class Link:
    """Text in a table that leads to a section of the page.

    Attributes:
        text: what is read.
        to: name of the section.
    """

    text: str
    to: str


class Page:
    """A report page, part by part. Sections, tables and pictures are numbered.

    Args:
        title: of the page.
        lead: one line below it, such as what was examined and when.
    """

    def __init__(self, title: str, lead: str = "") -> None:
        self._title = title
        self._lead = lead
        self._parts: list[str] = []
        self._contents: list[tuple[str, str, list[tuple[str, str]]]] = []
        self._tables = 0
        self._pictures = 0

    def section(self, heading: str, name: str = "") -> None:
        """Begin a section.

        Args:
            heading: text.
            name: by which links find it.
        """
        number = f"{len(self._contents) + 1}"
        place = name or f"section-{number}"
        self._contents.append((f"{number} {heading}", place, []))
        self._parts.append(f'<h2 id="{escape(place)}">{number} {escape(heading)}</h2>')

    def subsection(self, heading: str, name: str = "") -> None:
        """Begin a part of the section; arguments as for ``section``."""
        _, _, parts = self._contents[-1]
        number = f"{len(self._contents)}.{len(parts) + 1}"
        place = name or f"section-{number}"
        parts.append((f"{number} {heading}", place))
        self._parts.append(f'<h3 id="{escape(place)}">{number} {escape(heading)}</h3>')

    def text(self, text: str) -> None:
        """A paragraph."""
        self._parts.append(f"<p>{escape(text)}</p>")

    def lead_in(self, text: str) -> None:
        """A paragraph that stays with what follows."""
        self._parts.append(f'<p class="lead-in">{escape(text)}</p>')

    def notice(self, text: str) -> None:
        """A paragraph that the reader must not miss."""
        self._parts.append(f'<p class="notice">{escape(text)}</p>')

    def table(
        self,
        caption: str,
        columns: Sequence[str],
        rows: Sequence[Sequence[Any]],
        note: str = "",
    ) -> None:
        """A table. Columns of numbers, and of texts that begin with one, are set to the right.

        Args:
            caption: what it shows.
            columns: names of the columns, with units; no row of headings if all are empty.
            rows: their values; a `Link` leads to a section.
            note: a paragraph below.
        """
        self._tables += 1
        right = [_is_number([row[k] for row in rows]) for k in range(len(columns))]
        head = "".join(
            f"<th{_class(is_right)}>{_heading(name)}</th>"
            for name, is_right in zip(columns, right, strict=True)
        )
        head = f"<thead><tr>{head}</tr></thead>" if any(columns) else ""
        body = "".join(
            "<tr>"
            + "".join(
                f"<td{_class(is_right)}>{_cell(value)}</td>"
                for value, is_right in zip(row, right, strict=True)
            )
            + "</tr>"
            for row in rows
        )
        short = ' class="short"' if len(rows) <= _SHORT else ""
        above = f"<b>Table {self._tables}.</b> {escape(_begun(caption))}"
        self._parts.append(
            f"<table{short}><caption>{above}</caption>{head}<tbody>{body}</tbody></table>"
        )
        if note:
            self._parts.append(f'<p class="note">{escape(note)}</p>')

    def picture(self, caption: str, png: bytes) -> None:
        """A picture.

        Args:
            caption: what it shows, also for those who cannot see it.
            png: the picture.
        """
        self._pictures += 1
        content, said = base64.b64encode(png).decode(), escape(_begun(caption))
        self._parts.append(
            f'<figure><img alt="{said}" src="data:image/png;base64,{content}">'
            f"<figcaption><b>Figure {self._pictures}.</b> {said}</figcaption></figure>"
        )

    def code(self, text: str) -> None:
        """Text as a computer reads it, such as a command."""
        self._parts.append(f"<pre>{escape(text)}</pre>")

    def command(self, words: Sequence[str]) -> None:
        """A command of the shell; its lines are broken between words alone.

        Args:
            words: the command and its arguments, without quotes.
        """
        parts = " ".join(f"<span>{escape(shlex.quote(each))}</span>" for each in words)
        self._parts.append(f'<pre class="command">{parts}</pre>')

    def json(self, values: Mapping[str, Any]) -> None:
        """Values as JSON."""
        self.code(json_text(values, indent=1))

    def signatures(self) -> None:
        """A section with space for signatures."""
        self.section("Signatures", "signatures")
        rows = "".join(
            f"<tr><td>{who}</td><td>Name</td><td>Date</td><td>Signature</td></tr>"
            for who in _TO_SIGN
        )
        self._parts.append(f'<table class="sign"><tbody>{rows}</tbody></table>')

    def write(self, path: str | os.PathLike[str]) -> None:
        """Write the page, whole or not at all.

        Raises:
            ResultsError: the page cannot be written.
        """
        title = escape(self._title)
        lead = f'<p class="lead">{escape(self._lead)}</p>' if self._lead else ""
        text = (
            f'<!doctype html>\n<html lang="en"><head><meta charset="utf-8"><title>{title}</title>'
            f"<style>{STYLE}</style></head>\n<body><h1>{title}</h1>{lead}\n"
            f"{self._list()}\n" + "\n".join(self._parts) + "\n</body></html>\n"
        )
        with replacing(path, ResultsError) as temporary:
            temporary.write_text(text, encoding="utf-8")

    def _list(self) -> str:
        """The list of contents."""
        if not self._contents:
            return ""
        items = ""
        for heading, name, parts in self._contents:
            below = "".join(f"<li>{_anchor(text, to)}</li>" for text, to in parts)
            items += f"<li>{_anchor(heading, name)}{f'<ol>{below}</ol>' if below else ''}</li>"
        return f"<nav><b>Contents</b><ol>{items}</ol></nav>"


def picture(figure: Figure) -> bytes:
    """A figure of Matplotlib as PNG, without blank margins."""
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", bbox_inches="tight")
    return buffer.getvalue()


def _begun(caption: str) -> str:
    """A caption with a capital at its beginning."""
    return caption[:1].upper() + caption[1:]


def _anchor(text: str, to: str) -> str:
    return f'<a href="#{escape(to)}">{escape(text)}</a>'


def _class(is_right: bool) -> str:
    return ' class="number"' if is_right else ""


def _heading(name: str) -> str:
    """The name of a column; its unit stays in one piece."""
    unit = _UNIT.search(name)
    if unit is None:
        return escape(name)
    before = escape(name[: unit.start()])
    return f'{before}<span class="unit">{escape(unit.group())}</span>'


def _cell(value: Any) -> str:
    if isinstance(value, Link):
        return _anchor(value.text, value.to)
    text = "-" if value is None else escape(str(value))
    if text in _MARKS:
        return f'<span class="{_MARKS[text]}">{text}</span>'
    return f'<span class="long">{text}</span>' if _LONG.search(text) else text


def _is_number(values: Sequence[Any]) -> bool:
    """Whether all that a column has are numbers, and it has some."""
    known = [each for each in values if each not in (None, "-", "")]
    return bool(known) and all(_reads_as_number(each) for each in known)


def _reads_as_number(value: Any) -> bool:
    if isinstance(value, Link):
        return False
    try:
        float(str(value).rstrip(" %").replace(",", ""))
    except ValueError:
        return False
    return True
