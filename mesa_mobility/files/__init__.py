"""Files on disk: complete or absent, zip archives, and a cache of what has been read."""
