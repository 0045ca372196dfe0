from .frequency_response import transmissibility as transmissibility
from .grid import frequency_grid as frequency_grid
from .random_sources import RandomLoad as RandomLoad
from .random_vibration import random_response as random_response
from .stepped import stepped_sine as stepped_sine
