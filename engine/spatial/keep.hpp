// Record of a step: peaks, overturning, and end of the history.
#pragma once
#include "run.hpp"

namespace rocking::spatial {
namespace ROCKING_ISA {

// Records the peak of a step, and the passage over the contact.
template <int D>
void Run<D>::keep(double start, double at, Vec before, Vec spin) {
    fastest_ = greater(fastest_, dot(velocity_, velocity_));
    // the cosine of the tilt changes from falling to rising: the peak is in the step
    const bool falling = before.x * spin.y - before.y * spin.x < 0.0, rising = z_.x * velocity_.y - z_.y * velocity_.x > 0.0;
    if (falling && rising) follow(start, at, before);
    const double level = z_.x * z_.x + z_.y * z_.y;
    if (level > peak_) peak_ = level, peak_time_ = time_;
    if (!(leaning_over(body_, z_, stance_->at) > 0.0)) {
        over_time_ = kNan, over_contact_ = over_number_ = -1;
    } else if (std::isnan(over_time_)) {
        double low = 0.0, high = at;
        for (int k = 0; k < kHalvings; ++k) {
            const double middle = 0.5 * (low + high);
            const Vec up = vec(value_at(step_.s.z, step_.s.order, middle));
            (leaning_over(body_, up, contact_at(up)) > 0.0 ? high : low) = middle;
        }
        over_time_ = start + high * step_.length;
        over_contact_ = stance_->contact, over_number_ = stance_->number;
    }
}

template <int D>
void Run<D>::follow(double start, double at, Vec before) {
    double slopes[kMostOrder + 1];
    const int order = step_.s.order;
    for (int k = 1; k <= order; ++k) slopes[k - 1] = -k * step_.c[k][3];
    if (!(slopes[0] > 0.0)) return;
    const double top = first_fall(slopes, order - 1);
    if (top > at) return;
    const Vec up = vec(value_at(step_.s.z, order, top));
    const double level = up.x * up.x + up.y * up.y;
    if (level > peak_ && level >= before.x * before.x + before.y * before.y) peak_ = level, peak_time_ = start + top * step_.length;
}

// True if the history has ended.
template <int D>
void Run<D>::look_for_end() {
    if (z_.z <= 0.0) {
        if (std::isnan(over_time_)) over_time_ = time_;
        return stop(kOverturned, kGood);
    }
    if (time_ < horizon_) return;
    const bool tired = time_ > horizon_ + kPatience / body_.p;
    const bool inside = !(leaning_over(body_, z_, stance_->at) > 0.0);
    if (tired || (inside && kinetic() + potential() < body_.mass * set_.gravity * body_.lift)) stop(kRocked, kGood);
}

template <int D>
void Run<D>::finish_step() {
    touching_ = 0;
    look_for_end();
}

}  // namespace ROCKING_ISA
}  // namespace rocking::spatial
