"""The planar engine: Taylor series between events, event times exact to rounding, complementarity at events.

A step ends at the next sample of the motion or earlier, so that no step crosses a kink of the motion. An event is a
zero of a polynomial. A body at rest skips the segments that cannot move the body.
"""

import math

import numpy as np

from rocking.dynamics.plane_frictional.base import (
    BOTH,
    FLIGHT,
    REST,
    ContactState,
    Mode,
    PlaneBase,
    away,
    kept,
    kinetic,
)
from rocking.dynamics.plane_frictional.event_functions import (
    TOLERANCE,
    ModeEnd,
    NextMode,
    choose,
    consistent,
    event_functions,
    excited_stretches,
    first_end,
    weight_of,
)
from rocking.dynamics.plane_frictional.history import Blow, History
from rocking.dynamics.plane_frictional.impact_resolution import (
    GroundContact,
    Struck,
    cleaned,
    impact_of,
    largest_speed,
    shock,
    strike_with,
)
from rocking.dynamics.plane_frictional.mode_series import GroundSeries, ModeSeries, mode_series, value
from rocking.dynamics.plane_frictional.settings import ContactSettings
from rocking.dynamics.taylor import first_fall, shifted
from rocking.motions.segments import Segments
from rocking.outcome import Status

_ORDER = 30
_STRETCH_END = 1.0 - 1e-13
_CLOSED = 1e-13
_MAX_CHANGES = 40
_AFTER = 60.0


class ContactEngine:
    """Engine of one history."""

    def __init__(
        self,
        base: PlaneBase,
        segments: Segments,
        law: GroundContact,
        settings: ContactSettings,
        scale: float = 1.0,
    ) -> None:
        vertical = np.zeros_like(segments.horizontal) if segments.vertical is None else segments.vertical
        self.push, self.lift = segments.horizontal * scale, vertical * scale
        self.lift[:, 0] += settings.gravity
        self.step, self.count = segments.step, segments.count
        self.base, self.law, self.settings = base, law, settings
        self.pace = math.sqrt(settings.gravity / base.size)
        self.slowest = settings.rest_speed * math.sqrt(settings.gravity * base.size)
        self.history = History(self.count, settings.gravity)
        self.state, self.mode = ContactState(), REST
        self.stretch, self.tau = 0, 0.0
        self.tolerance, self.changed, self.events = TOLERANCE, 0, 0
        self.passed = math.nan
        self.ended: Status | None = None
        self.lies = False
        self.latest: ModeSeries | None = None

    def run(self, state: ContactState | None = None) -> History:
        self.state = state or ContactState()
        if any(away(self.base, self.state, foot) < 0.0 for foot in self.state.touching):
            self._strike(FLIGHT)
        else:
            self._change()
        if self.ended is None:
            ground = self._ground(self.step)
            self.latest = mode_series(self.base, self.state, self.mode, ground, self.law.friction, _ORDER)
        self.history.sample(0, self.state, self.mode, self.latest, 0.0)
        while self.ended is None and not self._over():
            self._step()
        history = self.history
        history.status, history.lies = self.ended or Status.GOOD, self.lies
        history.passed, history.end, history.last_x = self.passed, self._now, self.state.x
        return history

    # ---- from event to event ----------------------------------------------------------------------------------------

    @property
    def _now(self) -> float:
        return (self.stretch + self.tau) * self.step

    def _over(self) -> bool:
        """Return True if the motion is over, and the body is not near overturning."""
        if self.stretch < self.count:
            return False
        side = 1 if self.state.rotation > 0.0 else -1
        tilted = abs(self.state.rotation) > self.base.slenderness_angle(side)
        return not tilted or (self.stretch - self.count) * self.step * self.pace > _AFTER

    def _ground(self, unit: float) -> GroundSeries:
        """Return the ground motion from the present time on, over a unit of time."""
        if self.stretch >= self.count:
            return GroundSeries([0.0], [self.settings.gravity], unit)
        width = unit / self.step
        push = shifted(self.push[self.stretch].tolist(), self.tau, width)
        lift = shifted(self.lift[self.stretch].tolist(), self.tau, width)
        return GroundSeries(push, lift, unit)

    def _step(self) -> None:
        if self.mode == REST and self._skip():
            return
        ground = self._ground((1.0 - self.tau) * self.step)
        full = mode_series(self.base, self.state, self.mode, ground, self.law.friction, _ORDER)
        fraction = self._trusted(full)
        if not fraction > 0.0:
            self._shocked(Status.NOT_FINITE if full.stiff > 0.0 else Status.NO_CONTACT_FORCE)
            return
        trusted, trusted_ground = full.shortened(fraction), ground.shortened(fraction)
        stretch = trusted.unit * self.pace
        functions = event_functions(self.base, self.mode, trusted, self.law.friction, weight_of(trusted_ground))
        if full.stiff <= 0.0 or not consistent(functions, stretch, self.tolerance):
            self._change()
            return
        end = first_end(functions, stretch, self.tolerance)
        at, kind = end or (1.0, None)
        self.history.pass_through(self._now, trusted, trusted_ground, at, self.law.friction)
        self._watch_top(trusted, at)
        self.latest = trusted
        self.tolerance, self.changed = TOLERANCE, 0
        reached = trusted.state(at, self.mode.feet)
        self._move(self.tau + at * fraction * (1.0 - self.tau) if at * fraction < 1.0 else 1.0, reached, at)
        if kind is not None:
            self._end(kind, trusted, at)

    def _trusted(self, full: ModeSeries) -> float:
        """Return the fraction of a series over which the last terms are below the tolerance."""
        if not all(np.isfinite(c).all() for c in (full.rotation, full.x, full.rise)):
            return 0.0
        if full.rotation.size <= _ORDER:
            return 1.0
        fraction, size = 1.0, self.base.size
        series = [(full.rotation, 1.0), (full.x, size), *((gap, size) for gap in full.gaps.values())]
        for c, unit in series:
            for k in (_ORDER - 1, _ORDER):
                over = abs(c[k]) / (self.settings.tolerance * unit)
                if over > 1.0:
                    fraction = min(fraction, float(over) ** (-1.0 / k))  # Eq. 52
        return fraction

    def _move(self, tau: float, reached: ContactState, at: float) -> None:
        self.state = kept(self.base, reached, self.mode.feet, stick=self.mode.slip == 0)
        if tau > _STRETCH_END:
            self.stretch, self.tau = self.stretch + 1, 0.0
            self.history.sample(self.stretch, self.state, self.mode, self.latest, at)
        else:
            self.tau = tau

    def _watch_top(self, series: ModeSeries, at: float) -> None:
        """Record the passage of the centre of mass over the foot."""
        side = 1 if value(series.rotation, at) > 0.0 else -1
        gap = -side * series.rotation
        gap[0] += self.base.slenderness_angle(side)
        if value(gap, at) >= 0.0:
            self.passed = math.nan
        elif gap[0] > 0.0 or math.isnan(self.passed):
            self.passed = self._now + ((first_fall(gap.tolist()) or 0.0) if gap[0] > 0.0 else 0.0) * series.unit

    # ---- events -----------------------------------------------------------------------------------------------------

    def _end(self, kind: ModeEnd, series: ModeSeries, at: float) -> None:
        """Process the end of a mode."""
        self.events += 1
        if self.events >= self.settings.most_events:
            self.ended = Status.TOO_MANY_EVENTS
        if kind is ModeEnd.LYING:
            self.lies, self.ended = True, Status.GOOD
        elif kind is ModeEnd.LANDING:
            self._land(series, at)
        else:
            if kind is ModeEnd.STICKING:
                self.state = kept(self.base, self.state, self.mode.feet, stick=True)
            self._change()

    def _land(self, series: ModeSeries, at: float) -> None:
        before, mode = self.state, self.mode
        if mode.feet:
            upright = before._replace(rotation=0.0, rise=0.0)
            self.state = kept(self.base, upright, mode.feet, stick=mode.slip == 0)._replace(touching=BOTH)
        else:
            slack = _CLOSED * self.base.size
            feet = tuple(foot for foot in BOTH if value(series.gaps[foot], at) <= slack)
            if len(feet) == 2:
                self.state = before._replace(rotation=0.0, rise=0.0, touching=feet)
            else:
                rise = self.base.rise_on(feet[0], before.rotation)
                self.state = before._replace(rise=rise, touching=feet)
        self._strike(mode, self.settings.gravity * (before.rise - self.state.rise))

    def _strike(self, mode: Mode, dropped: float = 0.0) -> None:
        """Compute an impact of the feet in contact. `dropped` is the energy of position corrections [J/kg]."""
        struck = self._struck(self.state, mode)
        if isinstance(struck, Status):
            self.ended = struck
            return
        self._continue_after(struck, dropped)

    def _shocked(self, otherwise: Status) -> None:
        """Apply an impact without collision. If it does not apply, end the history with a status."""
        self.events, self.changed = self.events + 1, self.changed + 1
        stopped = self.events >= self.settings.most_events or self.changed > _MAX_CHANGES
        struck = otherwise if stopped else shock(self.base, self.state, self.law)
        if isinstance(struck, Status):
            self.ended = otherwise
            return
        self.history.shocks += 1
        self._continue_after(struck)

    def _continue_after(self, struck: Struck, dropped: float = 0.0) -> None:
        """Record an impact, and choose the next mode."""
        before = self.state
        rounding = 1e-13 * largest_speed(self.base, before)
        after = self._calmed(cleaned(self.base, struck, rounding))
        loss = dropped + kinetic(self.base, before) - kinetic(self.base, after)
        self.history.strike(Blow(self._now, before, struck, after, loss))
        self.state = after
        self._change()

    def _struck(self, before: ContactState, mode: Mode) -> Struck | Status:
        law = self.law
        if law.restitution is not None and len(mode.feet) == 1:
            foot = -mode.feet[0]
            r = law.restitution[0 if foot < 0 else 1]
            imposed = strike_with(self.base, before, foot, law.friction, r)
            if isinstance(imposed, Struck):
                return imposed
        bounces = {foot: law.bounce * -away(self.base, before, foot) for foot in before.touching}
        bounce = {foot: law.bounce if v > self.slowest else 0.0 for foot, v in bounces.items()}
        struck, replaced = impact_of(self.base, before, law, bounce)
        self.history.replaced += replaced
        return struck

    def _calmed(self, after: ContactState) -> ContactState:
        """Return a slow body after an impact as a body at rest on both feet, if the contact forces allow this."""
        slow = max(abs(after.w), abs(after.spin) * self.base.size) <= self.slowest
        if after.touching != BOTH or not slow:
            return after
        calm = kept(self.base, after, BOTH, stick=False)
        if abs(calm.u) <= self.slowest * 1e-3:
            calm = calm._replace(u=0.0)
        mode = choose(self.base, calm, self._ground(1.0 / self.pace), self.law.friction)
        return calm if isinstance(mode, NextMode) and mode.mode.feet == BOTH else after

    def _change(self) -> None:
        """Choose the next mode."""
        if self.ended is not None:
            return
        self.changed += 1
        next_mode = choose(self.base, self.state, self._ground(1.0 / self.pace), self.law.friction)
        if isinstance(next_mode, Status):
            self._shocked(next_mode)
            return
        if self.changed > _MAX_CHANGES:
            self.ended = Status.STUCK
        self.tolerance = max(
            next_mode.tolerance, TOLERANCE * 10.0 ** min(self.changed - 3, 5) if self.changed > 3 else 0.0
        )
        self.mode = next_mode.mode
        self.history.change(self._now, self.mode)
        if self.mode.feet != BOTH and len(self.mode.feet) == 1 and self.state.rotation != 0.0:
            self.state = kept(self.base, self.state, self.mode.feet, stick=self.mode.slip == 0)

    # ---- rest -------------------------------------------------------------------------------------------------------

    def _skip(self) -> bool:
        """Keep the body at rest over segments that cannot move the body. Return True if there were such segments."""
        if not hasattr(self, "_excited"):
            self._excited = excited_stretches(self.base, self.push, self.lift, self.law.friction)
        index = int(np.searchsorted(self._excited, self.stretch))
        until = int(self._excited[index]) if index < self._excited.size else self.count
        if until <= self.stretch:
            return False
        while self.stretch < until:
            ground = self._ground((1.0 - self.tau) * self.step)
            self.latest = mode_series(self.base, self.state, REST, ground, self.law.friction, _ORDER)
            self.history.pass_through(self._now, self.latest, ground, 1.0, self.law.friction)
            self._move(1.0, self.state, 1.0)
        return True
