"""The browser of tests and benchmarks: where it is, and how it starts without network, screen and graphics card."""

import shutil

PATIENCE = 120_000  # ms: for what a page waits for, on a machine with other work: WebGL in software, and long jobs
CHROMIUM = shutil.which("chromium") or "/usr/bin/chromium"
FLAGS = [
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--use-gl=angle",
    "--use-angle=swiftshader",  # WebGL in software: what every machine has
    "--enable-unsafe-swiftshader",
]
