"""The calibration of the preset `default`: what it is calibrated on, and the command."""
