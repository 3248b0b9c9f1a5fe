"""Reading of measured tracks: rows of files, their unit, what is wrong with them, headings."""
