"""The session behind a page: its thread, its run and what the page shows of it."""
