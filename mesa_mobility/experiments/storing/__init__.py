"""How a store keeps runs: rows, files of rows, and who may write."""
