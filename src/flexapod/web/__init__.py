"""The server and the page of `flexapod serve`: answers as JSON, jobs as binary streams, the built page in `static`.

It computes nothing itself and keeps no state of a page: each request carries its design and pose.

May import: design, mechanics, workspace, excitation, simulation, vibration.
"""
