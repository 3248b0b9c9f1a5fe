"""How the hot path is compiled; nothing here is about people."""
