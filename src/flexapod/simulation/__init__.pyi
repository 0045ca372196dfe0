from .integrator import Run as Run
from .time_simulation import simulate as simulate
from .time_simulation import simulate_many as simulate_many
