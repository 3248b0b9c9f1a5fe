"""Pages of PDF files as pictures to draw over."""

from __future__ import annotations

import base64
import binascii
import json
from importlib.util import find_spec
from typing import Any

from mesa_mobility.errors import MobilityError
from mesa_mobility.files.apart import output_of

MOST_BYTES = 10_000_000
"""Bytes of a PDF."""

SECONDS, MEMORY = 20.0, 1_000_000_000
"""Seconds and bytes that drawing a page may take."""


def picture_of(data: Any, number: Any) -> dict[str, Any]:
    """A page of a PDF: its ``picture`` as a data URL, and the number of all ``pages``.

    Args:
        data: the PDF in base 64.
        number: of the page, from 1 on.

    Raises:
        MobilityError: no PDF that can be read, or pypdfium2 is not installed.
    """
    if find_spec("pypdfium2") is None:
        raise MobilityError(
            "pages of a PDF need pypdfium2: pip install 'mesa-mobility[pdf]' brings it; or save "
            "the page as PNG"
        )
    if not isinstance(data, str) or len(data) > MOST_BYTES * 4 // 3 + 4:
        raise MobilityError(f"PDF: expected at most {MOST_BYTES / 1e6:g} MB")
    if type(number) is not int or not 1 <= number <= 100_000:
        raise MobilityError(f"PDF: got page {number!r:.40}, expected 1 or more")
    try:
        file = base64.b64decode(data, validate=True)
        words = [str(number), str(MEMORY)]
        output, status = output_of("mesa_mobility.pdf_page", words, SECONDS, file)
        answer = json.loads(output) if output else {"error": f"it ended with status {status}"}
    except (binascii.Error, TimeoutError, ValueError) as error:
        answer = {"error": error}
    if "error" in answer:
        raise MobilityError(f"PDF: cannot be read ({answer['error']})")
    return {"picture": f"data:image/png;base64,{answer['png']}", "pages": answer["pages"]}
