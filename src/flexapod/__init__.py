"""Flexapod: dynamic stability, vibration and design of flexible 6-UPS Stewart platforms (hexapods).

SI units and rad/s throughout. Names are loaded when first used, so that `import flexapod` is quick.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

_HOMES = {
    "errors": [
        "ArgumentError",
        "ClusterError",
        "DesignError",
        "FlexapodError",
        "InfeasibleError",
        "KinematicsError",
        "MissingExtraError",
        "OutputError",
        "PathError",
        "PoseError",
        "SimulationError",
        "SingularPoseError",
        "UnstableError",
    ],
    "hexapod": ["Damping", "Hexapod", "LegPart", "Legs", "Limits", "load", "packaged_designs", "template"],
    "pose": ["Motion", "Pose"],
    "jointfile": ["read_joints"],
    "kinematics": [
        "JointAngles",
        "LegRates",
        "LimitsCheck",
        "check_limits",
        "condition_number",
        "force_transformation",
        "forward_kinematics",
        "home_pose",
        "inverse_kinematics",
        "joint_angles",
        "leg_distance",
        "leg_rates",
    ],
    "dynamics": [
        "Energy",
        "EquationsOfMotion",
        "Reactions",
        "energy",
        "equations_of_motion",
        "forward_dynamics",
        "inverse_dynamics",
        "joint_reactions",
    ],
    "statics": ["Equilibrium", "hold", "static_equilibrium"],
    "modal": [
        "EnergyShares",
        "ModeDescription",
        "NaturalModes",
        "Sensitivity",
        "describe_modes",
        "energy_shares",
        "frequency_sensitivity",
        "natural_modes",
        "near_repeated",
        "stability_index",
    ],
    "linear": ["DampedModes", "Linearisation", "StateSpace", "linearise"],
    "waypoints": ["Path"],
    "path": ["PathIndex", "path_index", "path_loads"],
    "requirements": ["PathRequirements"],
    "planning": ["LegSpeed", "Plan", "plan_path", "plan_slice"],
    "sampling": ["sampling_time"],
    "feedback": ["Controller"],
    "laws": ["ForceFeedback", "PID", "VelocityFeedback"],
    "assessment": ["ClosedLoop"],
    "position_loops": ["GainWarning", "closed_loop", "gain_map"],
    "damping_loops": ["open_zeros", "root_locus"],
    "isolators": ["controlled_transmissibility", "h_infinity", "lqg"],
    "sampled": ["Hardware", "simulate_control"],
    "schedule": ["gain_schedule"],
    "excitation": [
        "Excitation",
        "half_sine_pulse",
        "half_sine_shock",
        "harmonic",
        "polynomial",
        "sine_sweep",
        "smooth_step",
    ],
    "recordings": ["read_time_series", "time_series"],
    "spectra": ["Spectrum", "flat_spectrum", "ground_noise", "random_motion", "sea_motion", "sea_spectrum", "vc_curve"],
    "trajectory": ["Run"],
    "simulation": ["simulate", "simulate_many"],
    "response": ["random_response", "transmissibility"],
    "stepped": ["stepped_sine"],
    "animate": ["animate_mode", "animate_simulation"],
    "posesets": ["Box", "PoseSet", "low_discrepancy", "pose_grid", "pose_path", "random_poses"],
    "sweeps.dataset": ["sweep"],
    "sweeps.store": ["SweepStore", "open_sweep"],
    "sweeps.summary": ["SweepSummary", "summarise"],
    "sweeps.worst": ["WorstPose", "worst_pose"],
    "sweeps.cluster": ["cluster"],
    "optimal.variables": ["JointCircle", "Variable"],
    "optimal.places": ["Workspace"],
    "optimal.objectives": ["Dexterity", "LeastIndex", "MeanIndex"],
    "optimal.constraints": [
        "ConditionNumber",
        "Deflection",
        "DesignLimits",
        "Footprint",
        "JointAngle",
        "LegClearance",
        "LegLength",
        "Stroke",
        "TotalMass",
    ],
    "optimal.optimise": ["OptimalDesign", "optimise"],
    "optimal.pareto": ["ParetoFront", "pareto_front"],
    "robust": ["Payload", "Robustness", "Uncertain", "robustness"],
    "interchange.bodies": ["nearest_physical"],
    "interchange.mjcf": ["write_mjcf"],
    "interchange.sdf": ["write_sdf"],
    "interchange.statespace": ["write_mat"],
    "interchange.urdf": ["write_urdf"],
}
_HOME_OF = {name: home for home, names in _HOMES.items() for name in names}
__all__ = sorted([*_HOME_OF, "__version__"])


def __getattr__(name: str) -> Any:
    if name not in _HOME_OF:
        raise AttributeError(f"module 'flexapod' has no attribute {name!r}")
    value = getattr(import_module(f"flexapod.{_HOME_OF[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return __all__


if TYPE_CHECKING:  # what type checkers and editors see
    from flexapod.animate import animate_mode as animate_mode
    from flexapod.animate import animate_simulation as animate_simulation
    from flexapod.assessment import ClosedLoop as ClosedLoop
    from flexapod.damping_loops import open_zeros as open_zeros
    from flexapod.damping_loops import root_locus as root_locus
    from flexapod.dynamics import Energy as Energy
    from flexapod.dynamics import EquationsOfMotion as EquationsOfMotion
    from flexapod.dynamics import Reactions as Reactions
    from flexapod.dynamics import energy as energy
    from flexapod.dynamics import equations_of_motion as equations_of_motion
    from flexapod.dynamics import forward_dynamics as forward_dynamics
    from flexapod.dynamics import inverse_dynamics as inverse_dynamics
    from flexapod.dynamics import joint_reactions as joint_reactions
    from flexapod.errors import ArgumentError as ArgumentError
    from flexapod.errors import ClusterError as ClusterError
    from flexapod.errors import DesignError as DesignError
    from flexapod.errors import FlexapodError as FlexapodError
    from flexapod.errors import InfeasibleError as InfeasibleError
    from flexapod.errors import KinematicsError as KinematicsError
    from flexapod.errors import MissingExtraError as MissingExtraError
    from flexapod.errors import OutputError as OutputError
    from flexapod.errors import PathError as PathError
    from flexapod.errors import PoseError as PoseError
    from flexapod.errors import SimulationError as SimulationError
    from flexapod.errors import SingularPoseError as SingularPoseError
    from flexapod.errors import UnstableError as UnstableError
    from flexapod.excitation import Excitation as Excitation
    from flexapod.excitation import half_sine_pulse as half_sine_pulse
    from flexapod.excitation import half_sine_shock as half_sine_shock
    from flexapod.excitation import harmonic as harmonic
    from flexapod.excitation import polynomial as polynomial
    from flexapod.excitation import sine_sweep as sine_sweep
    from flexapod.excitation import smooth_step as smooth_step
    from flexapod.feedback import Controller as Controller
    from flexapod.hexapod import Damping as Damping
    from flexapod.hexapod import Hexapod as Hexapod
    from flexapod.hexapod import LegPart as LegPart
    from flexapod.hexapod import Legs as Legs
    from flexapod.hexapod import Limits as Limits
    from flexapod.hexapod import load as load
    from flexapod.hexapod import packaged_designs as packaged_designs
    from flexapod.hexapod import template as template
    from flexapod.interchange.bodies import nearest_physical as nearest_physical
    from flexapod.interchange.mjcf import write_mjcf as write_mjcf
    from flexapod.interchange.sdf import write_sdf as write_sdf
    from flexapod.interchange.statespace import write_mat as write_mat
    from flexapod.interchange.urdf import write_urdf as write_urdf
    from flexapod.isolators import controlled_transmissibility as controlled_transmissibility
    from flexapod.isolators import h_infinity as h_infinity
    from flexapod.isolators import lqg as lqg
    from flexapod.jointfile import read_joints as read_joints
    from flexapod.kinematics import JointAngles as JointAngles
    from flexapod.kinematics import LegRates as LegRates
    from flexapod.kinematics import LimitsCheck as LimitsCheck
    from flexapod.kinematics import check_limits as check_limits
    from flexapod.kinematics import condition_number as condition_number
    from flexapod.kinematics import force_transformation as force_transformation
    from flexapod.kinematics import forward_kinematics as forward_kinematics
    from flexapod.kinematics import home_pose as home_pose
    from flexapod.kinematics import inverse_kinematics as inverse_kinematics
    from flexapod.kinematics import joint_angles as joint_angles
    from flexapod.kinematics import leg_distance as leg_distance
    from flexapod.kinematics import leg_rates as leg_rates
    from flexapod.laws import PID as PID
    from flexapod.laws import ForceFeedback as ForceFeedback
    from flexapod.laws import VelocityFeedback as VelocityFeedback
    from flexapod.linear import DampedModes as DampedModes
    from flexapod.linear import Linearisation as Linearisation
    from flexapod.linear import StateSpace as StateSpace
    from flexapod.linear import linearise as linearise
    from flexapod.modal import EnergyShares as EnergyShares
    from flexapod.modal import ModeDescription as ModeDescription
    from flexapod.modal import NaturalModes as NaturalModes
    from flexapod.modal import Sensitivity as Sensitivity
    from flexapod.modal import describe_modes as describe_modes
    from flexapod.modal import energy_shares as energy_shares
    from flexapod.modal import frequency_sensitivity as frequency_sensitivity
    from flexapod.modal import natural_modes as natural_modes
    from flexapod.modal import near_repeated as near_repeated
    from flexapod.modal import stability_index as stability_index
    from flexapod.optimal.constraints import ConditionNumber as ConditionNumber
    from flexapod.optimal.constraints import Deflection as Deflection
    from flexapod.optimal.constraints import DesignLimits as DesignLimits
    from flexapod.optimal.constraints import Footprint as Footprint
    from flexapod.optimal.constraints import JointAngle as JointAngle
    from flexapod.optimal.constraints import LegClearance as LegClearance
    from flexapod.optimal.constraints import LegLength as LegLength
    from flexapod.optimal.constraints import Stroke as Stroke
    from flexapod.optimal.constraints import TotalMass as TotalMass
    from flexapod.optimal.objectives import Dexterity as Dexterity
    from flexapod.optimal.objectives import LeastIndex as LeastIndex
    from flexapod.optimal.objectives import MeanIndex as MeanIndex
    from flexapod.optimal.optimise import OptimalDesign as OptimalDesign
    from flexapod.optimal.optimise import optimise as optimise
    from flexapod.optimal.pareto import ParetoFront as ParetoFront
    from flexapod.optimal.pareto import pareto_front as pareto_front
    from flexapod.optimal.places import Workspace as Workspace
    from flexapod.optimal.variables import JointCircle as JointCircle
    from flexapod.optimal.variables import Variable as Variable
    from flexapod.path import PathIndex as PathIndex
    from flexapod.path import path_index as path_index
    from flexapod.path import path_loads as path_loads
    from flexapod.planning import LegSpeed as LegSpeed
    from flexapod.planning import Plan as Plan
    from flexapod.planning import plan_path as plan_path
    from flexapod.planning import plan_slice as plan_slice
    from flexapod.pose import Motion as Motion
    from flexapod.pose import Pose as Pose
    from flexapod.posesets import Box as Box
    from flexapod.posesets import PoseSet as PoseSet
    from flexapod.posesets import low_discrepancy as low_discrepancy
    from flexapod.posesets import pose_grid as pose_grid
    from flexapod.posesets import pose_path as pose_path
    from flexapod.posesets import random_poses as random_poses
    from flexapod.position_loops import GainWarning as GainWarning
    from flexapod.position_loops import closed_loop as closed_loop
    from flexapod.position_loops import gain_map as gain_map
    from flexapod.recordings import read_time_series as read_time_series
    from flexapod.recordings import time_series as time_series
    from flexapod.requirements import PathRequirements as PathRequirements
    from flexapod.response import random_response as random_response
    from flexapod.response import transmissibility as transmissibility
    from flexapod.robust import Payload as Payload
    from flexapod.robust import Robustness as Robustness
    from flexapod.robust import Uncertain as Uncertain
    from flexapod.robust import robustness as robustness
    from flexapod.sampled import Hardware as Hardware
    from flexapod.sampled import simulate_control as simulate_control
    from flexapod.sampling import sampling_time as sampling_time
    from flexapod.schedule import gain_schedule as gain_schedule
    from flexapod.simulation import simulate as simulate
    from flexapod.simulation import simulate_many as simulate_many
    from flexapod.spectra import Spectrum as Spectrum
    from flexapod.spectra import flat_spectrum as flat_spectrum
    from flexapod.spectra import ground_noise as ground_noise
    from flexapod.spectra import random_motion as random_motion
    from flexapod.spectra import sea_motion as sea_motion
    from flexapod.spectra import sea_spectrum as sea_spectrum
    from flexapod.spectra import vc_curve as vc_curve
    from flexapod.statics import Equilibrium as Equilibrium
    from flexapod.statics import hold as hold
    from flexapod.statics import static_equilibrium as static_equilibrium
    from flexapod.stepped import stepped_sine as stepped_sine
    from flexapod.sweeps.cluster import cluster as cluster
    from flexapod.sweeps.dataset import sweep as sweep
    from flexapod.sweeps.store import SweepStore as SweepStore
    from flexapod.sweeps.store import open_sweep as open_sweep
    from flexapod.sweeps.summary import SweepSummary as SweepSummary
    from flexapod.sweeps.summary import summarise as summarise
    from flexapod.sweeps.worst import WorstPose as WorstPose
    from flexapod.sweeps.worst import worst_pose as worst_pose
    from flexapod.trajectory import Run as Run
    from flexapod.waypoints import Path as Path
