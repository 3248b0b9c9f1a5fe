"""The commands about plug-ins: which are installed, and skeletons of new ones."""
