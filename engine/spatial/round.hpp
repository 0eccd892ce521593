// A history of a body with a round base: contact at one point of the rim if the body is nearly flat, otherwise rolling.
#pragma once
#include "run.hpp"

namespace rocking::spatial {
namespace ROCKING_ISA {

template <int D>
const Pivot& Run<D>::rim(double x, double y, int contact) {
    used_ = 1 - used_;
    rims_[used_] = rim_point(body_, x, y);
    rims_[used_].contact = contact;
    return rims_[used_];
}

template <int D>
void Run<D>::start_round() {
    const double sine = std::sqrt(z_.x * z_.x + z_.y * z_.y);
    const double x = sine > kStopRolling ? z_.x : -velocity_.y, y = sine > kStopRolling ? z_.y : velocity_.x;
    stance_ = x == 0.0 && y == 0.0 ? &body_.face : &rim(-x, -y, sine > kStartRolling ? kRolling : kVertex);
    if (stance_->contact == kRest) flatten();
}

// One step on the rim; `order`: order of its series.
template <int D>
void Run<D>::step_on_rim(int order, double angle) {
    if (stance_->contact == kRolling) {
        const Vec axes[3] = {x_, y_, z_};
        Rolling(body_, axes, velocity_, order, step_);
        spelled_ = true;
        const Series& s = step_.s;
        if (!within_trust(greater(largest(vec(s.w[order])), greater(largest(vec(s.z[order])), largest(vec(s.x[order])))), angle, order)) return;
        read_rolling(body_, step_);
    } else {
        order <= 8 ? advance<8>(angle) : advance<kMostOrder>(angle);
    }
    if (done_) return;
    double normal[kMostOrder + 1];
    normal_force(step_, normal);
    double letting = first_zero(normal, step_.s.order - 2, false, 0.0);
    const double turn = rim_event(body_, *stance_, step_, landing_);
    const bool held = letting <= 1.0 && nearly_flat(body_, vec(value_at(step_.s.z, step_.s.order, letting)));
    if (held) letting = kNone;
    const double at = lesser(1.0, lesser(letting, turn));
    arrive(at, whole_ && at == 1.0);
    if (z_.z <= 0.0) return finish_step();  // the body lies on the ground; other events cannot follow
    if (turn == at) return change_on_rim();
    if (letting == at) return released(-1);
    if (held) made_.held += at * step_.length;
    if (lies_down()) return land({&body_.face, {}, 0.0}, 0);
    finish_step();
}

// True if a round base with nearly no energy stays flat; without this rule rolling would never end.
template <int D>
bool Run<D>::lies_down() const {
    if (!(nearly_flat(body_, z_) && calm())) return false;
    return forces(body_, body_.face, {}, z_, field_now()).support > 0.0;
}

template <int D>
void Run<D>::change_on_rim() {
    const bool rolls = stance_->contact == kRolling;
    const double sine = std::sqrt(z_.x * z_.x + z_.y * z_.y);
    if (!rolls && sine > (landing_ ? kLanding : 0.5 * kStartRolling)) {
        stance_ = &rim(stance_->at.x, stance_->at.y, kRolling), landing_ = false;
        return guard();
    }
    if (rolls && sine > 0.5 * kLanding) {
        // a rigid rim continues to roll past the flat position; only at zero distance from it there is an impact
        const Vec falls = cross(z_, velocity_);
        const double past = std::fabs(z_.x * falls.y - z_.y * falls.x);  // Eq. 327
        if (past < kFlat * std::sqrt(falls.x * falls.x + falls.y * falls.y) && z_.x * falls.x + z_.y * falls.y < 0.0)
            stance_ = &rim(falls.x, falls.y, kVertex), landing_ = true;
        return guard();
    }
    landing_ = false;
    if (rolls) {
        // the tilt is so small that the point of contact is fixed
        stance_ = &rim(stance_->at.x, stance_->at.y, kVertex);
        return guard();
    }
    flatten();
    const State now = state();
    const Pivot& far = rim(-now.pivot.x, -now.pivot.y, kVertex);
    const double push = impulse_support(body_, now, far, projected(body_, now, far));
    const Vec after = velocity_after(body_, now, far, static_cast<int>(row_.law), row_.coefficient);
    const bool opens = dot(cross(after, now.pivot - far.at), now.up) > 0.0;
    land(opens && push >= 0.0 ? Choice{&far, after, push} : Choice{&body_.face, {}, push}, 0);
}

}  // namespace ROCKING_ISA
}  // namespace rocking::spatial
