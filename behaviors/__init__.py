"""The shipped behaviours, each a plug-in like any other."""

from mesa_mobility.behaviors.exits.exit_choice import Choosing, ExitChoice
from mesa_mobility.behaviors.exits.familiar_exit import FamiliarExit
from mesa_mobility.behaviors.exits.nearest_exit import NearestExit
from mesa_mobility.behaviors.exits.quickest_exit import QuickestExit
from mesa_mobility.behaviors.exits.random_utility import RandomUtility
from mesa_mobility.behaviors.exits.social_influence import SocialInfluence
from mesa_mobility.behaviors.groups.following import Following
from mesa_mobility.behaviors.groups.walk_together import WalkTogether
from mesa_mobility.behaviors.groups.walking_abreast import WalkingAbreast
from mesa_mobility.behaviors.headway import Headway
from mesa_mobility.behaviors.interference import Interference
from mesa_mobility.behaviors.keep_distance import KeepDistance
from mesa_mobility.behaviors.personal_space import PersonalSpace
from mesa_mobility.behaviors.places.attraction import Attraction, Attractions
from mesa_mobility.behaviors.places.queueing import Counter, Queueing
from mesa_mobility.behaviors.right_of_way import RightOfWay
from mesa_mobility.behaviors.room_ahead import RoomAhead
from mesa_mobility.behaviors.routes.blocked_ways import BlockedWays
from mesa_mobility.behaviors.routes.congestion_routing import CongestionRouting
from mesa_mobility.behaviors.routes.familiar_routes import FamiliarRoutes
from mesa_mobility.behaviors.routes.hazards import Hazard, Hazards
from mesa_mobility.behaviors.routes.signs import Sign, Signs
from mesa_mobility.behaviors.sideways import Sideways
from mesa_mobility.behaviors.speed_ahead import SpeedAhead
from mesa_mobility.behaviors.steering.anticipation import Anticipation
from mesa_mobility.behaviors.steering.corner_spreading import SpreadAtCorners
from mesa_mobility.behaviors.steering.course_choice import ChooseCourse
from mesa_mobility.behaviors.steering.speed_adaptation import AdaptSpeed
from mesa_mobility.behaviors.steering.speed_compensation import CompensateSpeed
from mesa_mobility.behaviors.stepping import Stepping
from mesa_mobility.behaviors.target import FacingDeviation, TargetDistance
from mesa_mobility.behaviors.velocity import (
    Displacement,
    PreferredSpeed,
    PreferredVelocity,
    VelocityChange,
)

__all__ = [
    "AdaptSpeed",
    "Anticipation",
    "Attraction",
    "Attractions",
    "BlockedWays",
    "ChooseCourse",
    "Choosing",
    "CompensateSpeed",
    "CongestionRouting",
    "Counter",
    "Displacement",
    "ExitChoice",
    "FacingDeviation",
    "FamiliarExit",
    "FamiliarRoutes",
    "Following",
    "Hazard",
    "Hazards",
    "Headway",
    "Interference",
    "KeepDistance",
    "NearestExit",
    "PersonalSpace",
    "PreferredSpeed",
    "PreferredVelocity",
    "Queueing",
    "QuickestExit",
    "RandomUtility",
    "RightOfWay",
    "RoomAhead",
    "Sideways",
    "Sign",
    "Signs",
    "SocialInfluence",
    "SpeedAhead",
    "SpreadAtCorners",
    "Stepping",
    "TargetDistance",
    "VelocityChange",
    "WalkTogether",
    "WalkingAbreast",
]
