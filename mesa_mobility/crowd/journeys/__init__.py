"""Routes with gates to cross and places to visit, and waits."""
