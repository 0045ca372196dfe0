"""What processes that compute for the server load beforehand. Only they import it: it spares what they do without."""

from importlib import import_module

from flexapod.optional import ASKED_OF_ARRAYS, spare

spare(ASKED_OF_ARRAYS)
for _name in ("web.worker", "vibration.frequency_response", "simulation.time_simulation"):
    import_module(f"flexapod.{_name}")
