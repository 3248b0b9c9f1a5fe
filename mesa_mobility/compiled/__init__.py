"""How the hot path is compiled; nothing here knows about people."""
