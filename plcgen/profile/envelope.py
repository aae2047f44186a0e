"""The protection envelope of a hoist over travel (seed 000, figure 5, as a trip curve).

v_trip(S) = min(1.15 V, max(1.10 v(S), v(S) + 0.3), v_safe(d)),
v_safe(d) = -a_b t_r + sqrt((a_b t_r)^2 + 2 a_b d + v_e^2):
the speed from which a brake a_b that acts after t_r brings the hoist to v_e on the distance d that is left.
Within the ramps v(S) is taken as the creep speed, so that the curve does not close on a standing hoist.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from plcgen.job import HoistLimits
from plcgen.profile.reference import Samples
from plcgen.profile.transition import Transition


@dataclass(frozen=True)
class Envelope:
    """The curve between two stops, for a trip that accelerates from one and decelerates to the other."""

    limits: HoistLimits
    acceleration: Transition
    deceleration: Transition
    acceleration_begin: float
    deceleration_end: float

    @property
    def overspeed_velocity(self) -> float:
        """1.15 V."""
        return self.limits.envelope.overspeed_factor * self.limits.max_velocity

    @property
    def reaction_velocity(self) -> float:
        """a_b t_r: the speed that the brake takes away in the reaction time."""
        return self.limits.envelope.brake_deceleration * self.limits.envelope.reaction_time

    @property
    def velocity_squared_at_end(self) -> float:
        """(a_b t_r)^2 + v_e^2: the radicand of v_safe at the stop itself."""
        return self.reaction_velocity**2 + self.limits.envelope.end_velocity**2

    def velocity(self, travelled: Samples, to_go: Samples) -> Samples:
        """v_trip at a distance from the stop behind and from the stop ahead, arrays of one shape."""
        guard = self.limits.envelope
        nominal = np.minimum(
            self.acceleration.velocities(travelled - self.acceleration_begin),
            self.deceleration.velocities(to_go - self.deceleration_end),
        )
        tracking = np.maximum(guard.tracking_factor * nominal, nominal + guard.tracking_margin)
        left = np.maximum(to_go, 0.0)
        safe = np.sqrt(self.velocity_squared_at_end + 2 * guard.brake_deceleration * left) - self.reaction_velocity
        return np.minimum(np.minimum(self.overspeed_velocity, tracking), safe)
