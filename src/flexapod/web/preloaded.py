"""What processes that compute for the server load beforehand. Only they import it: it spares what they do without."""

from importlib import import_module

from flexapod.optional import ASKED_OF_ARRAYS, spare

spare(ASKED_OF_ARRAYS)
import_module("flexapod.web.worker")
import_module("flexapod.vibration.frequency_response")
import_module("flexapod.simulation.time_simulation")
