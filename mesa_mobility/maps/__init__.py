"""The mobility maps that ship."""
