"""Studies of many poses: sweeps in memory, on disk and on clusters, their summaries, and the worst pose of a box."""
