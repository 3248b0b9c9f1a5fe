"""Scenarios with stairs, several storeys and lifts."""
