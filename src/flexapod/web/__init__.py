"""The page of `flexapod serve`: a server of JSON and binary points, and the built front end in `static`.

A face: it computes nothing itself. The server keeps no state of any page; each request carries its design and pose.
"""
