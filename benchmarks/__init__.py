"""Speed and behaviour beyond what tests can show: each file is a command."""
