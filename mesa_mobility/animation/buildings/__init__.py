"""Buildings as three-dimensional views show them: storeys, flights and shafts of lifts."""
