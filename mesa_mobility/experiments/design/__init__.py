"""Points of the parameter space of a model: values, and designs that choose them."""
