"""The report of one run: a page for those who have to judge a design."""
