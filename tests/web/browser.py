"""The browser of tests and benchmarks: where it is, and how it starts without network, screen and graphics card."""

import shutil

PATIENCE = 120_000  # ms: for what a page waits for, on a machine with other work: WebGL in software, and long jobs
#: Without windows, profiles and extensions, a page takes half of the processor's time.
CHROMIUM = shutil.which("chromium-headless-shell") or shutil.which("chromium")
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
