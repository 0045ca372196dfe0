from .batch import simulate_many as simulate_many
from .run import SimulationRun as SimulationRun
from .time_simulation import simulate as simulate
