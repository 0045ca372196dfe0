from .frequency_response import random_response as random_response
from .frequency_response import transmissibility as transmissibility
from .stepped import stepped_sine as stepped_sine
