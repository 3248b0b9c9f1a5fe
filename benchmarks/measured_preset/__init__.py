"""The calibration of the preset `measured`: what it is calibrated on, and the command."""
