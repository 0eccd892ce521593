// One history: steps to the end of every sample, or to an earlier event.
#pragma once
#include "record.hpp"
#include "rolling.hpp"

namespace rocking::spatial {
namespace ROCKING_ISA {

constexpr double kPull = 1e-9, kPatience = 300.0;
constexpr int kStuck = 100, kPiled = 60, kUpkeep = 16, kHalvings = 60;

// reach: largest angles 1.5 * rate * h for which the series of each order meets the tolerance: x^(n + 1) / (n + 1)! = tolerance.
struct Orders {
    static constexpr int count = 5;
    static constexpr int order[count] = {4, 6, 8, 12, 16};
    double reach[count];
    explicit Orders(double tolerance) {
        for (int i = 0; i < count; ++i) reach[i] = std::exp((std::log(tolerance) + std::lgamma(order[i] + 2.0)) / (order[i] + 1));
    }
};

template <int D>
class Run {
public:
    Run(const Body& body, const Motion& motion, const Row& row, const Settings& settings, const Orders& orders, std::vector<Sample>* trace)
        : body_(body), motion_(motion), row_(row), set_(settings), orders_(orders), trace_(trace) {
        slow_ = settings.rest_speed * std::sqrt(settings.gravity * body.size);
        weak_ = settings.rest_speed * settings.rest_speed * body.mass * settings.gravity * body.lift;
        end_ = motion.count ? motion.times[motion.count] : 0.0;
        horizon_ = greater(row.horizon, end_);
    }

    Result run() {
        start();
        while (!done_) stance_->contact == kRest ? rest() : move();
        return result();
    }

private:
    // ---- the course -------------------------------------------------------------------------------------------------

    void start();
    void rest();
    void move();
    Result result() const;

    void stop(int outcome, int status) { done_ = true, made_.outcome = outcome, made_.status = status; }

    // ---- a step -----------------------------------------------------------------------------------------------------

    void load_field(double length, bool is_full);
    template <int N>
    bool advance(double angle);
    template <int N>
    bool advance_on_edge(double angle);
    template <int N>
    bool advance_on(double angle) {
        return stance_->contact == kEdge ? advance_on_edge<N>(angle) : advance<N>(angle);
    }
    template <int N>
    bool nothing_near();
    bool within_trust(double size, double angle, int order);
    bool ends_hold() const;
    void spell_out();
    void locate();
    void shorten_step(double fraction);
    void arrive(double at, bool ends_stretch);
    void keep(double start, double at, Vec before, Vec spin);
    void follow(double start, double at, Vec before);
    void look_for_end();
    void finish_step();

    // ---- events -----------------------------------------------------------------------------------------------------

    const Pivot& rim(double x, double y, int contact);
    void start_round();
    void step_on_rim(int order, double angle);
    void change_on_rim();
    bool lies_down() const;
    void impact(int vertex);
    void stick(std::uint64_t closed);
    void released(int which);
    void land(const Choice& choice, std::uint64_t touching, double height = 0.0);
    void note(int kind, double before, double after);
    void guard() {
        at_once_ = time_ <= moment_ ? at_once_ + 1 : 0;
        moment_ = time_;
        if (at_once_ > kStuck || made_.events > set_.most_events) return stop(kFailed, kTooManyEvents);
        // a base with many vertices may have no step without impact, so the outcome is also checked here
        if (!done_ && time_ >= horizon_ && stance_->contact != kRest) look_for_end();
    }

    // ---- small parts ------------------------------------------------------------------------------------------------

    void stand(const Pivot& stance) {
        stance_ = &stance;
        if (stance.contact == kRest) flatten();
        else if (stance.contact == kEdge) level(stance.axis);
    }
    void flatten() {
        const double c = x_.x + y_.y, s = y_.x - x_.y, size = 1.0 / std::sqrt(c * c + s * s);
        x_ = {size * c, -size * s, 0.0}, y_ = {size * s, size * c, 0.0}, z_ = {0.0, 0.0, 1.0};
    }
    // Rotates the body by the smallest angle that makes an axis of the body horizontal.
    void level(Vec axis) {
        const double sine = dot(z_, axis), cosine = std::sqrt(1.0 - sine * sine);
        if (sine == 0.0) return;
        const Vec about = 1.0 / cosine * cross(axis, z_);
        const auto turned = [&](Vec v) { return cosine * v + sine * cross(about, v) + (1.0 - cosine) * dot(about, v) * about; };
        x_ = turned(x_), y_ = turned(y_), z_ = turned(z_);
        z_ = z_ - dot(z_, axis) * axis;
        straighten();
    }
    void straighten() {
        z_ = 1.0 / norm(z_) * z_;
        x_ = x_ - dot(x_, z_) * z_;
        x_ = 1.0 / norm(x_) * x_;
        y_ = cross(z_, x_);
    }
    Vec field_now() const {
        double g[3] = {0.0, 0.0, -set_.gravity};
        if (stretch_ < motion_.count) {
            const double* a = motion_.data + stretch_ * (D + 1) * 3;
            const double begin = motion_.times[stretch_], tau = (time_ - begin) / (motion_.times[stretch_ + 1] - begin);
            for (int i = 0; i < 3; ++i) {
                double total = 0.0;
                for (int d = D; d >= 0; --d) total = total * tau + a[3 * d + i];
                g[i] -= row_.scale * total;
            }
        }
        return g[0] * x_ + g[1] * y_ + g[2] * z_;
    }
    Vec contact_at(Vec up) const {
        if (stance_->contact != kRolling) return stance_->at;
        const double size = -body_.radius / std::sqrt(up.x * up.x + up.y * up.y);
        return {size * up.x, size * up.y, 0.0};
    }
    State state() const { return {stance_->at, velocity_, z_, field_now(), stance_->length * stance_->axis}; }
    double kinetic() const { return 0.5 * dot(velocity_, stance_->inertia * velocity_); }
    // True if nearly no energy remains. A falling body has negative energy, and is not at rest.
    bool calm() const { return kinetic() + std::fabs(potential()) < weak_; }
    double potential() const { return body_.mass * set_.gravity * rise(body_, z_, stance_->at); }

    const Body& body_;
    const Motion& motion_;
    const Row& row_;
    const Settings& set_;
    const Orders& orders_;
    std::vector<Sample>* trace_;
    double slow_, weak_, end_, horizon_;

    const Pivot* stance_ = nullptr;
    std::uint64_t touching_ = 0;
    Vec x_, y_, z_, velocity_;
    double time_ = 0.0, moment_ = -1.0;
    std::int64_t stretch_ = 0;
    int at_once_ = 0, upkeep_ = 0;

    Step step_;
    Turn turn_;
    bool spelled_ = true;  // true if the series of the axes exist; a step about an edge rarely needs them
    bool whole_ = false, to_horizon_ = false;
    bool landing_ = false;  // true if a round base falls flat
    bool sticks_ = false;  // true after accumulated impacts on this edge; then no end of the edge is released
    // peak_: square of the sine of the peak tilt
    double peak_ = 0.0, peak_time_ = 0.0, fastest_ = 0.0, over_time_ = kNan;
    int over_contact_ = -1, over_number_ = -1;
    Pivot rims_[2];
    int used_ = 0;
    Result made_;
    bool done_ = false;
};

}  // namespace ROCKING_ISA
}  // namespace rocking::spatial

#include "step.hpp"
#include "keep.hpp"
#include "events.hpp"
#include "round.hpp"
