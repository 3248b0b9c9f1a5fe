"""The server of the dashboard: its connections, and who gets an answer."""
