"""The calibration of the default preset: what it is calibrated on, and the command."""
