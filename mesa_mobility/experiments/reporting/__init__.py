"""The page that an experiment has found something on: tables and pictures."""
