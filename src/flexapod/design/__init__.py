"""Designs of hexapods: read from files and tables, checked, changed, and written.

May import: errors, conventions, pose.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
