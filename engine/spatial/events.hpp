// Events between steps: start, rest, uplift, impacts, and release of ends of edges.
#pragma once
#include "run.hpp"

namespace rocking::spatial {
namespace ROCKING_ISA {

template <int D>
void Run<D>::start() {
    const double* q = row_.attitude;
    const double size = 1.0 / std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    const double s = size * q[0], x = size * q[1], y = size * q[2], z = size * q[3];
    x_ = {1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - s * z), 2.0 * (x * z + s * y)};
    y_ = {2.0 * (x * y + s * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - s * x)};
    z_ = {2.0 * (x * z - s * y), 2.0 * (y * z + s * x), 1.0 - 2.0 * (x * x + y * y)};
    velocity_ = row_.velocity;
    made_.held = made_.lost = 0.0;
    peak_ = z_.x * z_.x + z_.y * z_.y;
    fastest_ = dot(velocity_, velocity_);
    if (body_.round) {
        start_round();
        if (stance_->contact != kRest) note(kUplift, 0.0, kinetic());
        return;
    }
    std::uint64_t touching = 0;
    stance_ = started(body_, velocity_, z_, touching);
    if (stance_->contact == kRest || touching == body_.every()) flatten();
    touching_ = touching & ~stance_->points;
    if (touching_ && largest(velocity_) == 0.0) {
        const Choice choice = held(body_, state(), touching, stance_);
        if (choice.stance) {
            stand(*choice.stance);
            touching_ = touching & ~stance_->points;
        }
    }
    if (stance_->contact != kRest) note(kUplift, 0.0, kinetic());
}

template <int D>
void Run<D>::rest() {
    velocity_ = {};
    double tau = 0.0;
    while (stretch_ < motion_.count && motion_.times[stretch_ + 1] <= time_) ++stretch_;
    if (stretch_ < motion_.count) {
        const double begin = motion_.times[stretch_];
        tau = (time_ - begin) / (motion_.times[stretch_ + 1] - begin);
    }
    const Uplift uplift = Rest<D>(body_, motion_, row_.scale, set_.gravity, x_, y_).next(stretch_, tau);
    if (uplift.stretch < 0) {
        time_ = greater(horizon_, time_);
        return stop(made_.events ? kRocked : kNoUplift, kGood);
    }
    stretch_ = uplift.stretch;
    const double begin = motion_.times[stretch_];
    time_ = greater(begin + uplift.tau * (motion_.times[stretch_ + 1] - begin), time_);
    const State now = state();
    const Pivot* stance = nullptr;
    if (!body_.round) stance = lifted(body_, now, uplift);
    if (body_.round && now.field.z < 0.0) {
        const Vec pressure = body_.centre.z * now.field - now.field.z * body_.centre;
        stance = &rim(pressure.x, pressure.y, kVertex);
    }
    if (!stance) return stop(kFailed, kLostContact);
    stand(*stance);
    touching_ = body_.every() & ~stance->points;
    note(kUplift, 0.0, 0.0);
    guard();
}

template <int D>
void Run<D>::impact(int vertex) {
    std::uint64_t closed = bit(vertex) | stance_->points;
    int count = 0;
    double gap = 0.0, rate = -kFar;
    for (int i = 0; i < body_.count; ++i) {
        const Vec arm = body_.vertices[i] - stance_->at;
        const double height = dot(arm, z_);
        gap = greater(gap, height), rate = greater(rate, dot(cross(velocity_, arm), z_));
        if (height <= kClosed * body_.size) closed |= bit(i);
        count += (closed & bit(i)) != 0;
    }
    const bool flat = gap <= kFlat * body_.size && rate <= kClosed * body_.size * norm(velocity_);  // Eq. 328
    if (stance_->contact == kEdge || count > 2 || flat) closed = body_.every();
    double height = 0.0;  // potential energy that is lost when the body is laid flat
    if (closed == body_.every()) height = potential(), flatten();
    if (at_once_ > kPiled) return stick(closed);
    land(landed(body_, state(), closed, static_cast<int>(row_.law), row_.coefficient), closed, height);
}

// After too many impacts at one time the largest set of touching points stays at rest, even under a tensile force.
template <int D>
void Run<D>::stick(std::uint64_t closed) {
    const double before = kinetic();
    const State now = state();
    const Pivot* stays = nullptr;
    any_candidate(body_, closed, [&](const Pivot& stance) { return stays = &stance, true; });
    const Vec after = plastic_after(body_, now, *stays);
    stand(*stays);
    velocity_ = after, touching_ = 0;
    sticks_ = stays->contact == kEdge;
    made_.lost += before - kinetic();
    note(kImpact, before, kinetic());
    guard();
}

template <int D>
void Run<D>::land(const Choice& landing, std::uint64_t touching, double height) {
    const double before = kinetic() + (stance_->contact == kRolling ? potential() : height);  // the height is lost
    if (!landing.stance) return stop(kFailed, kNotFinite);
    stand(*landing.stance);
    velocity_ = landing.velocity;
    const bool weak = calm();
    const Choice stays = settled(body_, state(), landing, touching, slow_, weak);
    stand(*stays.stance);
    velocity_ = stays.velocity;
    touching_ = touching & ~stays.stance->points;
    made_.lost += before - kinetic();
    note(kImpact, before, kinetic());
    if (stays.stance->contact == kRest) note(kComesToRest, 0.0, 0.0);
    guard();
}

template <int D>
void Run<D>::released(int which) {
    if (which < 0) return stop(leaning_over(body_, z_, stance_->at) > 0.0 ? kOverturned : kFailed, kLostContact);
    const int first = stance_->number, second = (first + 1) % body_.count;
    stand(body_.vertex[which == 0 ? second : first]);
    touching_ = bit(which == 0 ? first : second);
    note(kChange, kinetic(), kinetic());
    guard();
}

template <int D>
void Run<D>::note(int kind, double before, double after) {
    ++made_.events;
    made_.impacts += kind == kImpact;
    made_.uplifts += kind == kUplift;
    if (std::isnan(made_.first_uplift)) made_.first_uplift = time_;
    if (trace_) trace_->push_back({time_, kind, stance_->contact, stance_->number, before, after, x_, y_, z_, velocity_});
}

template <int D>
Result Run<D>::result() const {
    Result r = made_;
    r.end_time = time_;
    if (r.outcome == kFailed) return r;
    const bool over = r.outcome == kOverturned;
    r.still_rocking = r.outcome == kRocked && stance_->contact != kRest;
    r.peak_tilt = over ? 1.57079632679489661923 : std::asin(lesser(1.0, std::sqrt(peak_)));
    r.peak_time = over ? over_time_ : peak_time_;
    r.peak_spin = std::sqrt(fastest_);
    if (!over) return r;
    r.overturning_time = over_time_;
    r.direction = azimuth_of(x_, y_);
    r.over_contact = over_contact_, r.over_number = over_number_;
    return r;
}

}  // namespace ROCKING_ISA
}  // namespace rocking::spatial
