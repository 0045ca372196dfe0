"""Options that commands share, and how their words become designs, poses and numbers."""
