"""From tracks to choices."""
