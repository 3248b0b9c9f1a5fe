"""What joins the levels of a building: stairs, ramps, escalators and lifts."""
