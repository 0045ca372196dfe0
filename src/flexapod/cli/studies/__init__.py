"""What commands compute, from their options: modules that load NumPy and more, imported when a command runs."""
