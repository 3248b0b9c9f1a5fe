"""What is installed, what is in files, and what parameters a model takes."""
