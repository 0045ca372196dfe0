"""Optimal design: variables of a design, what they are to achieve and to respect, and the search for the best."""
