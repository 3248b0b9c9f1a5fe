"""Prints a page of a PDF as JSON: ``python -m mesa_mobility.pdf_page PAGE BYTES``.

The PDF comes by standard input, and BYTES limit the memory. pypdfium2 is compiled code, which a
damaged file may crash. So the drawing board starts this in a process of its own.
"""

import base64
import io
import json
import sys
from typing import Any

from mesa_mobility._memory import limit_memory

PIXELS = 2400
"""The longer side of the picture."""


def page_of(data: bytes, number: int) -> dict[str, Any]:
    """A page as PNG in base 64, and how many pages there are.

    Args:
        data: the PDF.
        number: of the page, from 1 on.

    Raises:
        ValueError: there is no such page.
        Exception: whatever pypdfium2 makes of a damaged file.
    """
    import pypdfium2

    document = pypdfium2.PdfDocument(data)
    if not 1 <= number <= len(document):
        raise ValueError(f"has {len(document)} pages, expected one of them, found {number}")
    page = document[number - 1]
    scale = PIXELS / max(page.get_width(), page.get_height(), 1.0)
    picture = io.BytesIO()
    page.render(scale=scale).to_pil().convert("L").save(picture, "png")
    return {"pages": len(document), "png": base64.b64encode(picture.getvalue()).decode()}


if __name__ == "__main__":
    limit_memory(int(sys.argv[2]))
    try:
        result = page_of(sys.stdin.buffer.read(), int(sys.argv[1]))
    except Exception as error:  # a damaged file leads pypdfium2 into errors of any kind
        result = {"error": " ".join(str(error).split())[:120] or type(error).__name__}
    print(json.dumps(result))
