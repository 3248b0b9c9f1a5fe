"""Reports as pages, and the figures of a saved run as files."""
