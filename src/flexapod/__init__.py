"""Flexapod."""
