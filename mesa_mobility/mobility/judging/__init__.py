"""How good a map is: what its people can do, and what it covers of people it has not seen."""
