"""What commands print besides results: progress, summaries, and a clean end after an interrupt."""
