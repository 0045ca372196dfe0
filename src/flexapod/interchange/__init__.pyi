from .matlab import write_mat as write_mat
from .mjcf import write_mjcf as write_mjcf
from .rigid_bodies import nearest_physical as nearest_physical
from .sdf import write_sdf as write_sdf
from .urdf import write_urdf as write_urdf
