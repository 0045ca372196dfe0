"""Stored sweeps to test with, and what tells whether two are the same."""

import hashlib
from pathlib import Path

import flexapod as fx

I = fx.load("mukherjee-i")
BOX = fx.Box.about(fx.home_pose(I), 0.08, 0.15)
POSES = fx.random_poses(BOX, 10_000, seed=5)


def content(path):
    """Every file of a store with the digest of its bytes."""
    files = (file for file in sorted(Path(path).rglob("*")) if file.is_file())
    return {str(file.relative_to(path)): hashlib.sha256(file.read_bytes()).hexdigest() for file in files}


def stored(path, poses=POSES, quantities=("omega_1", "cond_H"), design=I, **options):
    """A complete store, computed by threads."""
    store = fx.workspace.SweepStore.create(path, design, poses, quantities=quantities, **options)
    store.run()
    return store
