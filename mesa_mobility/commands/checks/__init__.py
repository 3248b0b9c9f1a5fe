"""The commands that check crowds: against tests of standards, and against measured crowds."""
