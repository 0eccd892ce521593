// A step of a history, and its record.
#pragma once
#include "run.hpp"

namespace rocking::spatial {
namespace ROCKING_ISA {

template <int D>
void Run<D>::load_field(double length, bool is_full) {
    double(*f)[3] = step_.field;
    for (int k = 0; k <= kMostOrder; ++k) f[k][0] = f[k][1] = f[k][2] = 0.0;
    if (stretch_ < motion_.count) {
        const double* a = motion_.data + stretch_ * (D + 1) * 3;
        const double begin = motion_.times[stretch_], unit = motion_.times[stretch_ + 1] - begin;
        for (int i = 0; i < 3; ++i) {
            double c[D + 1];
            for (int d = 0; d <= D; ++d) c[d] = -row_.scale * a[3 * d + i];
            if (!(is_full && time_ == begin)) shift(c, D, (time_ - begin) / unit, length / unit);
            for (int d = 0; d <= D; ++d) f[d][i] = c[d];
        }
    }
    f[0][2] -= set_.gravity;
}

template <int D>
void Run<D>::move() {
    while (stretch_ < motion_.count && motion_.times[stretch_ + 1] <= time_) ++stretch_;
    double rate = body_.p + norm(velocity_);
    // move at most half of the tilt towards flat, because the contact then moves fast along the rim
    if (stance_->contact == kRolling) {
        const Vec turning = cross(z_, velocity_);
        rate += 2.0 * std::sqrt((turning.x * turning.x + turning.y * turning.y) / (z_.x * z_.x + z_.y * z_.y));
    }
    double length = set_.longest / rate;
    whole_ = to_horizon_ = false;
    if (stretch_ < motion_.count) {
        const double left = motion_.times[stretch_ + 1] - time_;
        whole_ = length >= left;
        length = lesser(length, left);
    } else if (time_ < horizon_) {
        to_horizon_ = length >= horizon_ - time_;
        length = lesser(length, horizon_ - time_);
    }
    load_field(length, whole_);
    step_.length = length;
    step_.heading = stance_->contact == kEdge ? Vec{dot(x_, stance_->axis), dot(y_, stance_->axis), dot(z_, stance_->axis)} : Vec{};
    const double angle = 1.5 * rate * length;
    int which = D > 2 ? 3 : 0;
    while (which < Orders::count - 1 && angle > orders_.reach[which]) ++which;
    ++made_.steps;
    if (body_.round) return step_on_rim(Orders::order[std::max(which, 1)], angle);
    bool clear = false;
    switch (D > 2 ? std::max(which, 3) : which) {
        case 0: clear = advance_on<4>(angle); break;
        case 1: clear = advance_on<6>(angle); break;
        case 2: clear = advance_on<8>(angle); break;
        case 3: clear = advance_on<12>(angle); break;
        default: clear = advance_on<16>(angle);
    }
    if (done_) return;
    if (clear) {
        sticks_ = false;
        arrive(1.0, whole_);
        return finish_step();
    }
    spell_out();
    locate();
}

// The first event within the step.
template <int D>
void Run<D>::locate() {
    const double floor = 0.5 * kSlowOpening * norm({step_.field[0][0], step_.field[0][1], step_.field[0][2]}) * step_.length * step_.length;
    double contact = kNone, gap[kMostOrder + 1];
    int vertex = -1;
    for (int i = 0; i < 2; ++i) {
        const int number = stance_->watched[i];
        if (number < 0 || (i == 1 && number == stance_->watched[0])) continue;
        for (int k = 0; k <= step_.s.order; ++k) gap[k] = step_.c[k][i];
        const double at = first_zero(gap, step_.s.order, (touching_ & bit(number)) != 0, floor);
        if (at < contact || (at == contact && at <= 1.0 && number < vertex)) contact = at, vertex = number;
    }
    Release letting = first_release(body_, *stance_, step_);
    sticks_ = sticks_ && letting.which >= 0;
    if (sticks_) {  // no end of the edge is released
        double push[kMostOrder + 1];
        normal_force(step_, push);
        letting = {first_zero(push, step_.s.order - 2, false, 0.0), -1};
    }
    const double at = lesser(1.0, lesser(contact, letting.at));
    arrive(at, whole_ && at == 1.0);
    if (z_.z <= 0.0) return finish_step();  // the body lies on the ground; other events cannot follow
    if (contact == at) return impact(vertex);
    if (letting.at == at) return released(letting.which);
    if (stance_->contact == kEdge) {
        double normal[kMostOrder + 1], second[kMostOrder + 1];
        const int top = step_.s.order - 2;
        normal_force(step_, normal), second_force(*stance_, step_, second);
        const double b = value_of(second, top, at), a = value_of(normal, top, at) - b;
        if (lesser(a, b) < -kPull * set_.gravity) made_.held += step_.length;
    }
    finish_step();
}

// True if cheap bounds on the series exclude every event in the step.
template <int D>
template <int N>
bool Run<D>::advance(double angle) {
    const double length = step_.length;
    const Four state[4] = {packed(x_), packed(y_), packed(z_), packed(length * velocity_)};
    Series& s = step_.s;
    series<N, D>(*stance_, state, length, step_.field, s);
    spelled_ = true;
    if (!within_trust(greater(largest(vec(s.w[N])), greater(largest(vec(s.z[N])), largest(vec(s.x[N])))), angle, N)) return false;
    ROCKING_EACH_TERM
    for (int k = N; k >= 0; --k) {
        const Four z = s.z[k];
        step_.c[k] = stance_->gaps[0] * all_of<0>(z) + stance_->gaps[1] * all_of<1>(z) + stance_->gaps[2] * all_of<2>(z);
    }
    return nothing_near<N>();
}

template <int D>
template <int N>
bool Run<D>::advance_on_edge(double angle) {
    const Pivot& edge = *stance_;
    const double scale = body_.mass * step_.length * step_.length / edge.about_axis;
    double push[D + 1], weight[D + 1], strength = 0.0, across = 0.0, heavy = 0.0;
    for (int k = 0; k <= D; ++k) {
        const double* f = step_.field[k];
        const Vec field = f[0] * x_ + f[1] * y_ + f[2] * z_;
        push[k] = scale * dot(edge.lever, field), weight[k] = scale * dot(edge.level, field);
        strength += std::fabs(push[k]) + std::fabs(weight[k]);
        across += std::fabs(dot(step_.heading, {f[0], f[1], f[2]})), heavy += std::fabs(f[2]);
    }
    const double rate = step_.length * dot(velocity_, edge.axis);
    turn<N, D>(rate, push, weight, turn_);
    step_.s.order = N;
    spelled_ = false;
    if (!within_trust(greater(std::fabs(turn_.rate[N]), greater(std::fabs(turn_.sine[N]), std::fabs(turn_.cosine[N]))), angle, N)) return false;
    const Vec turned = cross(edge.axis, z_);
    const auto products = [&](Vec v) { return edge.gaps[0] * four(v.x) + edge.gaps[1] * four(v.y) + edge.gaps[2] * four(v.z); };
    const Four still = products(z_), turning = products(turned);
    ROCKING_EACH_TERM
    for (int k = N; k >= 0; --k) step_.c[k] = four(turn_.cosine[k]) * still - four(turn_.sine[k]) * turning;
    if (!nothing_near<N>()) return false;
    // both ends are compressive if the bound of their difference (moments about the middle of the edge) is below their
    // sum
    const double inverse = 1.0 / (step_.length * step_.length), fastest = std::fabs(rate) + strength;
    const double height = std::fabs(step_.c[0][2]) + fastest * norm(edge.level);
    const double apart = edge.skew * (strength + fastest * fastest) * inverse + height * across + heavy * edge.from_middle;
    if (2.0 * apart < edge.length * step_.least_normal) return true;
    spell_out();
    return ends_hold();
}

// Shortens a step whose series has not converged; false if the series is not finite.
template <int D>
bool Run<D>::within_trust(double size, double angle, int order) {
    if (!(size < 1e100)) {
        stop(kFailed, kNotFinite);
        return false;
    }
    const double left = size * angle / (order + 1);
    if (left > set_.tolerance) shorten_step(std::pow(set_.tolerance / left, 1.0 / (order + 1)));
    return true;
}

// True if the bounds prove that the contact force is compressive and no gap closes.
template <int D>
template <int N>
bool Run<D>::nothing_near() {
    Four later = four(0.0), sway = four(0.0);
    const Four zero = four(0.0);
    ROCKING_EACH_TERM
    for (int k = N; k >= 2; --k) {
        later = later + lesser(step_.c[k], zero);
        if (k >= 3) sway = sway + greater(step_.c[k], zero - step_.c[k]) * four(k * (k - 1.0));
    }
    const double inverse = 1.0 / (step_.length * step_.length);
    double normal = (2.0 * step_.c[2][2] - sway[2]) * inverse - step_.field[0][2];
    for (int k = 1; k <= D; ++k) normal -= std::fabs(step_.field[k][2]);
    step_.least_normal = normal;
    const double open = 1e-12 * body_.size + 1e-8 * set_.gravity * step_.length * step_.length;
    bool clear = normal > 0.0;
    for (int i = 0; i < 2; ++i) {
        const double first = step_.c[1][i];
        const int number = stance_->watched[i];
        const bool started = number >= 0 && (touching_ & bit(number));
        clear &= started ? first > open && first + later[i] > 0.0 : step_.c[0][i] + lesser(first, 0.0) + later[i] > 0.0;
    }
    return clear;
}

// Computes the series of the axes from the series of a rotation about an edge.
template <int D>
void Run<D>::spell_out() {
    if (spelled_) return;
    spelled_ = true;
    const Vec axis = stance_->axis;
    Four* rows[3] = {step_.s.x, step_.s.y, step_.s.z};
    const Vec starts[3] = {x_, y_, z_};
    for (int i = 0; i < 3; ++i) {
        const Vec along = dot(axis, starts[i]) * axis;
        const Four flat = packed(starts[i] - along), turned = packed(cross(axis, starts[i]));
        for (int k = 0; k <= step_.s.order; ++k) rows[i][k] = four(turn_.cosine[k]) * flat - four(turn_.sine[k]) * turned;
        rows[i][0] = rows[i][0] + packed(along);
    }
    for (int k = 0; k <= step_.s.order; ++k) step_.s.w[k] = four(turn_.rate[k]) * packed(axis);
}

// True if the forces at both ends of an edge are compressive throughout the step.
template <int D>
bool Run<D>::ends_hold() const {
    double normal[kMostOrder + 1], second[kMostOrder + 1];
    const int top = step_.s.order - 2;
    normal_force(step_, normal), second_force(*stance_, step_, second);
    double a = normal[0] - second[0], b = second[0];
    for (int k = 1; k <= top; ++k) a -= std::fabs(normal[k] - second[k]), b -= std::fabs(second[k]);
    return a > 0.0 && b > 0.0;
}

template <int D>
void Run<D>::shorten_step(double fraction) {
    spell_out();
    shorten(step_.s, fraction);
    step_.length *= fraction;
    double power = 1.0;
    for (int k = 0; k <= step_.s.order; ++k, power *= fraction) {
        turn_.cosine[k] *= power, turn_.sine[k] *= power, turn_.rate[k] *= power * fraction;
    }
    power = 1.0;
    for (int k = 0; k <= D; ++k, power *= fraction)
        for (int i = 0; i < 3; ++i) step_.field[k][i] *= power;
    whole_ = to_horizon_ = false;
}

// Moves the state to a time in the step.
template <int D>
void Run<D>::arrive(double at, bool ends_stretch) {
    const Series& s = step_.s;
    const Vec before = z_, spin = velocity_;
    const double start = time_, rate = 1.0 / step_.length;
    if (spelled_) {
        x_ = vec(value_at(s.x, s.order, at)), y_ = vec(value_at(s.y, s.order, at)), z_ = vec(value_at(s.z, s.order, at));
        velocity_ = rate * vec(value_at(s.w, s.order, at));
    } else {
        double sine = 0.0, cosine = 0.0, speed = 0.0;  // rotation over the complete step
        for (int k = s.order; k >= 0; --k) sine += turn_.sine[k], cosine += turn_.cosine[k], speed += turn_.rate[k];
        const Vec axis = stance_->axis;
        const auto turned = [&](Vec v) { return cosine * v + (1.0 - cosine) * dot(axis, v) * axis - sine * cross(axis, v); };
        const Vec x = turned(x_), y = turned(y_), z = turned(z_);
        time_ = start + step_.length;
        velocity_ = rate * speed * axis;
        const bool turns = before.x * spin.y - before.y * spin.x < 0.0 && z.x * velocity_.y - z.y * velocity_.x > 0.0;
        // series of the axes before the step
        if (turns || (leaning_over(body_, z, stance_->at) > 0.0 && std::isnan(over_time_))) spell_out();
        x_ = x, y_ = y, z_ = z;
    }
    if (stance_->contact == kRolling) stance_ = &rim(-z_.x, -z_.y, kRolling);
    if (at != 1.0 || ++upkeep_ >= kUpkeep) straighten(), upkeep_ = 0;
    time_ = start + at * step_.length;
    if (ends_stretch) time_ = motion_.times[++stretch_];
    else if (to_horizon_ && at == 1.0) time_ = horizon_;
    keep(start, at, before, spin);
    if (trace_) trace_->push_back({time_, -1, stance_->contact, stance_->number, 0.0, 0.0, x_, y_, z_, velocity_});
}

}  // namespace ROCKING_ISA
}  // namespace rocking::spatial
