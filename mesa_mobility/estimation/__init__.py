"""Weights of cost terms from measured people."""
