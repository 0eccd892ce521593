// Contacts of at most four touching vertices, with forces at up to three vertices. A table of effects gives the
// solution.
#pragma once
#include "contact.hpp"

namespace rocking::hull {

// a clear violation of a law is certain if (1 + friction) * residual of the directions is below this value
constexpr double kClearly = 1e-3;

// Effect of forces at a few vertices on their rates, in axes of the ground.
struct Yields {
    static constexpr std::size_t kMost = 4;
    Points at;
    Vec free[kMost], arms[kMost], acts[kMost];
    Mat yields[kMost][kMost];  // yields[j][k]: rate of vertex j per unit force at vertex k

    Yields(const Problem& p, const Points& vertices) : at(vertices) {
        const Mat &axes = p.axes, &soft = p.body->inverse, turns{axes * (soft * axes.a), axes * (soft * axes.b), axes * (soft * axes.c)};
        const double light = 1.0 / p.body->mass;
        for (std::size_t j = 0; j < at.size(); ++j) free[j] = axes * p.rate(at[j], p.linear, p.angular), arms[j] = axes * p.body->points[at[j]];
        for (std::size_t k = 0; k < at.size(); ++k) {
            const Vec s = acts[k] = p.places.empty() ? arms[k] : axes * p.place(at[k]);
            const Vec x = turns * Vec{0.0, s.z, -s.y}, y = turns * Vec{-s.z, 0.0, s.x}, z = turns * Vec{s.y, -s.x, 0.0};
            for (std::size_t j = 0; j < at.size(); ++j) {
                Mat& yield = yields[j][k] = {cross(x, arms[j]), cross(y, arms[j]), cross(z, arms[j])};
                yield.a.x += light, yield.b.y += light, yield.c.z += light;
            }
        }
    }
    int slot(int i) const { return static_cast<int>(std::find(at.begin(), at.end(), i) - at.begin()); }
};

// Forces at up to three vertices in contact.
struct Trial {
    static constexpr int kMost = 3;
    int n = 0, at[kMost];    // indices of these vertices in the table of effects
    Vec force[kMost];
    Flat ways[kMost];        // directions of the sliding members; zero for the others
};

// Largest violation of a law, over the mass; with this or a larger slack the trial is valid. sticking: members with a
// friction cone.
inline double excess(const Problem& p, const Yields& table, const Trial& t, unsigned sticking) {
    const double light = 1.0 / p.body->mass, mu = p.friction;
    double most = -kInfinite;
    unsigned members = 0;
    for (int k = 0; k < t.n; ++k) {
        const Vec f = t.force[k];
        members |= 1u << t.at[k], most = greater(most, -light * f.z);
        if (sticking >> k & 1 && mu < kInfinite) most = greater(most, light / (1.0 + mu) * (std::sqrt(f.x * f.x + f.y * f.y) - mu * f.z));
    }
    const int count = static_cast<int>(table.at.size());
    for (int i = 0; i < count && !(t.n > 2 && t.n == count); ++i) {
        if (members >> i & 1) continue;
        double opening = table.free[i].z;
        for (int k = 0; k < t.n; ++k) {
            const Mat& by = table.yields[i][t.at[k]];
            opening += t.force[k].x * by.a.z + t.force[k].y * by.b.z + t.force[k].z * by.c.z;
        }
        most = greater(most, -opening);
    }
    return most;
}

// Contact on an edge at rest: only the rotation about the edge is free. The moments determine the force across the edge
// at both ends.
struct Hinge {
    Vec first, along, lever, resist;  // a point of the edge, its direction, its moment arm, inertia about the edge
    double length = 0.0, about = 0.0;

    Hinge() = default;
    Hinge(const Body& b, int i, int j) : first(b.points[i]) {
        const Vec arm = b.points[j] - first;
        length = norm(arm), along = 1.0 / length * arm;
        lever = cross(along, first), resist = b.inertia * along;
        about = dot(along, resist) + b.mass * dot(lever, lever);
    }

    // Rates of the edge from rates without contact. gyro: rate of angular momentum at constant angular velocity, or
    // minus the angular momentum before an impact; spin: zero for impacts.
    void held(const Body& b, Vec gyro, Vec spin, Vec& linear, Vec& angular) const {
        const Vec swing = dot(spin, along) * spin - dot(spin, spin) * along, beta = -1.0 * cross(along, swing);
        const Vec centripetal = dot(spin, first) * spin - dot(spin, spin) * first, pull = cross(beta, first) + centripetal + linear;
        const double alpha = -(dot(resist, beta) + dot(along, gyro) + b.mass * dot(lever, pull)) / about;
        angular = alpha * along + beta, linear = -1.0 * (cross(angular, first) + centripetal);
    }

    // Total force, and the force at the second end. The force component along the edge acts at the first end only.
    std::pair<Vec, Vec> forces(const Body& b, Vec gyro, Vec linear, Vec angular, Vec before) const {
        const Vec force = b.mass * (linear - before), moment = b.inertia * angular + gyro - cross(first, force);
        return {force, 1.0 / length * cross(moment, along)};
    }
};

// Fractions of a force along the edge at both ends, in proportion to the remaining friction. side: forces across the
// edge.
inline void share_along(const double* normal, const double* side, double friction, double* by) {
    double weight[2], total = 0.0;
    for (int k = 0; k < 2; ++k) {
        weight[k] = greater(normal[k], 0.0);
        const double most = friction * weight[k];
        total += by[k] = std::sqrt(greater(most * most - side[k] * side[k], 0.0));  // Eq. 256
    }
    if (!(total > 0.0)) by[0] = weight[0], by[1] = weight[1], total = weight[0] + weight[1];
    if (!(total > 0.0)) by[0] = by[1] = 1.0, total = 2.0;
    by[0] /= total, by[1] /= total;
}

// All members stick. False if the general problem is needed: impulses away from their vertices, or over two vertices in
// motion.
inline bool stick(const Problem& p, const Yields& table, Trial& t) {
    if (!p.places.empty()) return false;
    for (int k = 0; k < t.n; ++k) t.ways[k] = {};
    if (t.n == 1) {
        t.force[0] = row_times(-1.0 * table.free[t.at[0]], inverse(table.yields[t.at[0]][t.at[0]]));
        return true;
    }
    if (t.n > 2 && p.forces) return false;
    const Body& b = *p.body;
    if (t.n == 2) {
        const Hinge hinge(b, table.at[t.at[0]], table.at[t.at[1]]);
        Vec linear = p.linear, angular;
        const Vec gyro = p.forces ? cross(p.spin, b.inertia * p.spin) : -1.0 * (b.inertia * p.angular);
        hinge.held(b, gyro, p.forces ? p.spin : Vec{}, linear, angular);
        const auto [force, end] = hinge.forces(b, gyro, linear, angular, p.linear);
        const Vec second = p.axes * end, sum = p.axes * force, first = sum - second, e = p.axes * hinge.along;
        const Flat across = unit(Flat{-e.y, e.x}), edge{across.y, -across.x};
        const double normal[2] = {first.z, second.z}, side[2] = {across.x * first.x + across.y * first.y, across.x * second.x + across.y * second.y};
        const double total = edge.x * sum.x + edge.y * sum.y;
        double by[2];
        share_along(normal, side, p.friction, by);
        for (int k = 0; k < 2; ++k) t.force[k] = {side[k] * across.x + by[k] * total * edge.x, side[k] * across.y + by[k] * total * edge.y, normal[k]};
        return true;
    }
    const Vec sum = -b.mass * (p.axes * p.linear), moment = -1.0 * (p.axes * (b.inertia * p.angular));
    const Vec *s = table.arms, r[3] = {s[t.at[0]], s[t.at[1]], s[t.at[2]]}, mean = 1.0 / 3.0 * (r[0] + r[1] + r[2]);
    const Vec left = moment - cross(mean, Vec{sum.x, sum.y, 0.0});
    const double x = -left.y - sum.z * r[0].x, y = left.x - sum.z * r[0].y;  // resultant of the normal forces, from the first vertex
    const double ax = r[1].x - r[0].x, ay = r[1].y - r[0].y, bx = r[2].x - r[0].x, by = r[2].y - r[0].y, area = ax * by - ay * bx;
    const double second = (x * by - y * bx) / area, third = (ax * y - ay * x) / area, normal[3] = {sum.z - second - third, second, third};
    double weight[3], all = 0.0;
    for (int k = 0; k < 3; ++k) all += weight[k] = greater(normal[k], 0.0);
    if (!(all > 0.0)) weight[0] = weight[1] = weight[2] = 1.0, all = 3.0;
    Vec loaded;
    for (int k = 0; k < 3; ++k) loaded = loaded + weight[k] / all * r[k];
    const Vec off = mean - loaded;
    const double couple = left.z + off.x * sum.y - off.y * sum.x;
    double resistance = 0.0;
    for (int k = 0; k < 3; ++k) resistance += weight[k] * ((r[k].x - loaded.x) * (r[k].x - loaded.x) + (r[k].y - loaded.y) * (r[k].y - loaded.y));
    const double rate = resistance > 0.0 ? couple / resistance : 0.0;
    for (int k = 0; k < 3; ++k)  // Eq. 255
        t.force[k] = {weight[k] * (sum.x / all - rate * (r[k].y - loaded.y)), weight[k] * (sum.y / all + rate * (r[k].x - loaded.x)), normal[k]};
    return true;
}

// Result of a trial after its solution.
enum class Verdict { kSolved, kExcluded, kUnsolved };

// Finds the directions of the members that begin to slide, and the forces; one other member may stick.
class Sliding {
  public:
    // one: sticking member, or -1. free: members with unknown direction. soft: their compliance to friction. limit:
    // largest violation.
    Sliding(const Problem& p, const Yields& table, Trial& t, int one, const int* free, int count, const double* soft, double limit)
        : p_(p), table_(table), t_(t), one_(one), count_(count), limit_(limit) {
        std::copy(free, free + count, free_), std::copy(soft, soft + count, soft_);
    }

    Verdict solve(double still) {
        const bool sticks = one_ >= 0;
        switch (t_.n) {
            case 1: return by<1, 0>(still);
            case 2: return sticks ? by<2, 2>(still) : by<2, 0>(still);
            default: return sticks ? by<3, 2>(still) : by<3, 0>(still);
        }
    }

  private:
    template <int n, int rest>
    Verdict by(double still) {
        if (count_ == 0) return forces<n, rest>() ? done<n, rest>() : Verdict::kExcluded;
        if (rest && !p_.forces && count_ == n - 1) return pivoted<n, rest>();
        const Flat begun[3] = {t_.ways[0], t_.ways[1], t_.ways[2]};
        Verdict verdict = Verdict::kUnsolved;
        const auto attempt = [&](auto method) {  // each method begins from the same directions
            if (verdict == Verdict::kUnsolved) std::copy(begun, begun + 3, t_.ways), verdict = method();
        };
        if (count_ == 1) attempt([&] { return alone<n, rest>(); });
        if (count_ < 3) attempt([&] { return turned<n, rest>(); });
        attempt([&] { return iterated<n, rest>(still); });
        if (count_ == 3) attempt([&] { return turned<n, rest>(); });
        return verdict;
    }

    // Rate of every member per unit of an unknown: the force of a member, or the tangential force of the sticking
    // member.
    void effect(int k) {
        const Flat d = t_.ways[k];
        for (int j = 0; j < t_.n; ++j) effects_[k][j] = row_times({-p_.friction * d.x, -p_.friction * d.y, 1.0}, table_.yields[t_.at[j]][t_.at[k]]);
    }

    // Forces for the directions, and their derivatives by the free directions.
    template <int n, int rest>
    bool forces(bool changes = false) {
        constexpr int m = n + rest;
        const int columns = m + 1 + (changes ? count_ : 0);
        double t[m][m + 4];
        for (int k = 0; k < n; ++k) effect(k);
        for (int j = 0; rest && j < n; ++j) effects_[n][j] = table_.yields[t_.at[j]][t_.at[one_]].a, effects_[n + 1][j] = table_.yields[t_.at[j]][t_.at[one_]].b;
        for (int f = 0; changes && f < count_; ++f) {
            const Flat d = t_.ways[free_[f]];
            for (int j = 0; j < n; ++j) turns_[f][j] = row_times({p_.friction * d.y, -p_.friction * d.x, 0.0}, table_.yields[t_.at[j]][t_.at[free_[f]]]);
        }
        const auto row = [&](int j, auto component) {
            const int i = j < n ? j : one_;
            for (int c = 0; c < m; ++c) t[j][c] = component(effects_[c][i]);
            t[j][m] = -component(table_.free[t_.at[i]]);
            for (int f = 0; f < columns - m - 1; ++f) t[j][m + 1 + f] = -component(turns_[f][i]);
        };
        for (int j = 0; j < n; ++j) row(j, [](Vec v) { return v.z; });
        if (rest) row(n, [](Vec v) { return v.x; }), row(m - 1, [](Vec v) { return v.y; });
        double threshold[m];
        for (int j = 0; j < m; ++j) threshold[j] = kSingular * t[j][j];
        for (int k = 0; k < m; ++k) {
            if (!(t[k][k] > threshold[k])) return false;
            const double over = 1.0 / t[k][k];
            for (int j = k + 1; j < m; ++j) {
                const double factor = t[j][k] * over;
                for (int c = k + 1; c < columns; ++c) t[j][c] -= factor * t[k][c];
            }
            for (int c = k + 1; c < columns; ++c) t[k][c] *= over;
        }
        for (int k = m - 1; k >= 0; --k)
            for (int c = m; c < columns; ++c) {
                double total = t[k][c];
                for (int l = k + 1; l < m; ++l) total -= t[k][l] * (c == m ? x_[l] : by_[c - m - 1][l]);
                (c == m ? x_[k] : by_[c - m - 1][k]) = total;
            }
        return true;
    }

    template <int m>
    Vec rate(int j) const {
        Vec rate = table_.free[t_.at[j]];
        for (int k = 0; k < m; ++k) rate = rate + x_[k] * effects_[k][j];
        return rate;
    }

    // Residuals perpendicular to the free directions, divided by the largest effect of friction, and their derivatives.
    template <int m>
    double across(double (&r)[3], double (&along)[3], double (&slopes)[kCorners][kCorners + 1]) const {
        double size = 0.0;
        for (int i = 0; i < count_; ++i) {
            const int j = free_[i];
            const Vec slip = rate<m>(j);
            const Flat d = t_.ways[j];
            const double over = 1.0 / greater(soft_[i] * std::fabs(x_[j]) + norm(slip), 1e-300);
            r[i] = (d.x * slip.y - d.y * slip.x) * over, along[i] = (d.x * slip.x + d.y * slip.y) * over;
            size = greater(size, std::fabs(r[i]));
            for (int f = 0; f < count_; ++f) {
                const double push = x_[free_[f]];
                Vec change = turns_[f][j];
                for (int k = 0; k < m; ++k) change = change + by_[f][k] * effects_[k][j];
                slopes[i][f] = push * (d.x * change.y - d.y * change.x) * over - (f == i ? along[i] : 0.0);
            }
            slopes[i][count_] = -r[i];
        }
        return size;
    }

    // After an impact the body rotates about the vertical through the sticking vertex, in one of two senses.
    template <int n, int rest>
    Verdict pivoted() {
        const Vec pivot = table_.arms[t_.at[one_]];
        Flat turn[2];
        double begun = 0.0;
        for (int j = 0; j < count_; ++j) {
            const Vec arm = table_.arms[t_.at[free_[j]]] - pivot;
            const Flat way = t_.ways[free_[j]];
            turn[j] = unit(Flat{-arm.y, arm.x}), begun += way.x * turn[j].x + way.y * turn[j].y;
        }
        for (double sense = begun < 0.0 ? -1.0 : 1.0, tries = 0; tries < 2; sense = -sense, ++tries) {
            for (int j = 0; j < count_; ++j) t_.ways[free_[j]] = {sense * turn[j].x, sense * turn[j].y};
            if (!forces<n, rest>()) continue;
            const Vec slip = rate<n + rest>(free_[0]);
            if (sense * (slip.x * turn[0].x + slip.y * turn[0].y) >= 0.0) return done<n, rest>();
        }
        return Verdict::kExcluded;
    }

    template <int n, int rest>
    Verdict turned() {  // Newton's method
        constexpr int m = n + rest;
        double r[3], along[3], slopes[kCorners][kCorners + 1];
        if (!forces<n, rest>(true)) return Verdict::kUnsolved;
        double size = across<m>(r, along, slopes);
        bool watched = true;
        for (int k = 0; k < kNewton; ++k) {
            if (size <= kStraight) {
                bool with = true;
                for (int j = 0; j < count_; ++j)
                    if (along[j] < -kStraight) t_.ways[free_[j]] = {-t_.ways[free_[j]].x, -t_.ways[free_[j]].y}, with = false;
                if (with) return done<n, rest>();
                if (!forces<n, rest>(true)) return Verdict::kUnsolved;
                size = across<m>(r, along, slopes);
                continue;
            }
            if (watched && size * (1.0 + p_.friction) <= kClearly) {
                watched = false;
                bool with = true;
                for (int j = 0; j < count_; ++j) with &= along[j] >= 0.0;
                double large = 0.0;
                for (int j = 0; j < n; ++j) large += std::fabs(x_[j]);
                write<n, rest>();
                if (with && excess(p_, table_, t_, 0) > limit_ + 0.1 * large / p_.body->mass) return Verdict::kExcluded;
            }
            const double before = size;
            if (!solved(count_, slopes)) return Verdict::kUnsolved;
            double most = 0.0, step[3];
            Flat from[3];
            for (int j = 0; j < count_; ++j) step[j] = slopes[j][count_], most = greater(most, std::fabs(step[j])), from[j] = t_.ways[free_[j]];
            double share = lesser(1.0, 0.5 / greater(most, 1e-300));
            if (!std::isfinite(most)) return Verdict::kUnsolved;
            for (int tries = 0; tries < kTries; ++tries, share *= 0.5) {
                for (int j = 0; j < count_; ++j) t_.ways[free_[j]] = unit(Flat{from[j].x - share * step[j] * from[j].y, from[j].y + share * step[j] * from[j].x});
                if (!forces<n, rest>(true)) return Verdict::kUnsolved;
                size = across<m>(r, along, slopes);
                if (size < before) break;
            }
        }
        return Verdict::kUnsolved;
    }

    // Iterates Eq. 257, then uses Newton's method.
    template <int n, int rest>
    Verdict iterated(double still) {
        Flat after[3], moved[3], last[3];
        double nearly = kNearly;
        for (int turn = 0; turn < kTurns; ++turn) {
            if (!forces<n, rest>()) return Verdict::kExcluded;
            double change = 0.0, along = 0.0, square = 0.0;
            for (int j = 0; j < count_; ++j) {
                const Vec slip = rate<n + rest>(free_[j]);
                const Flat before = t_.ways[free_[j]];
                const bool only_starts = std::sqrt(slip.x * slip.x + slip.y * slip.y) <= still && before.x * before.x + before.y * before.y > 0.0;
                const double push = soft_[j] * greater(x_[free_[j]], 0.0);
                after[j] = only_starts ? before : unit(Flat{slip.x + push * before.x, slip.y + push * before.y});
                moved[j] = {after[j].x - before.x, after[j].y - before.y};
                change = greater(change, std::sqrt(moved[j].x * moved[j].x + moved[j].y * moved[j].y));
                along += moved[j].x * last[j].x + moved[j].y * last[j].y, square += last[j].x * last[j].x + last[j].y * last[j].y;
            }
            if (change <= kStraight) return done<n, rest>();
            if (change <= nearly) {
                Flat reached[3];
                for (int j = 0; j < count_; ++j) reached[j] = t_.ways[free_[j]], t_.ways[free_[j]] = after[j];
                const Verdict verdict = turned<n, rest>();
                if (verdict != Verdict::kUnsolved) return verdict;
                for (int j = 0; j < count_; ++j) t_.ways[free_[j]] = reached[j];
                nearly = 0.0;
            }
            // every third iteration extrapolates the last two changes as a geometric series (Aitken)
            const double ratio = turn % 3 == 2 && square > 0.0 ? along / square : 0.0;
            const double further = std::fabs(ratio) < 0.98 ? ratio / (1.0 - ratio) : 0.0;
            for (int j = 0; j < count_; ++j) {
                t_.ways[free_[j]] = further != 0.0 ? unit(Flat{after[j].x + further * moved[j].x, after[j].y + further * moved[j].y}) : after[j];
                last[j] = moved[j];
            }
        }
        return Verdict::kUnsolved;
    }

    // Finds the direction of the only vertex that begins to slide. Its force determines all forces, so one equation for
    // the angle remains.
    template <int n, int rest>
    Verdict alone() {
        constexpr int m = n - 1 + rest, room = m ? m : 1;
        const int slot = free_[0], here = t_.at[slot];
        if (!(t_.ways[slot].x != 0.0 || t_.ways[slot].y != 0.0)) return Verdict::kUnsolved;
        const auto component = [](Vec v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; };
        int from[room], axis[room], count = 0;
        for (int k = 0; k < n; ++k)
            if (k != slot) effect(k), from[count] = k, axis[count++] = 2;
        for (int k = 0; k < rest; ++k) from[count] = one_, axis[count++] = k;
        const auto answer = [&](int j, int k) {  // rate of member j per unit of another force
            const Mat& by = table_.yields[t_.at[j]][t_.at[from[k]]];
            return axis[k] == 0 ? by.a : axis[k] == 1 ? by.b : effects_[from[k]][j];
        };
        double t[room][room + 4];
        for (int j = 0; j < m; ++j) {
            for (int k = 0; k < m; ++k) t[j][k] = component(answer(from[j], k), axis[j]);
            const Mat& by = table_.yields[t_.at[from[j]]][here];
            t[j][m] = -component(table_.free[t_.at[from[j]]], axis[j]);
            t[j][m + 1] = -component(by.a, axis[j]), t[j][m + 2] = -component(by.b, axis[j]), t[j][m + 3] = -component(by.c, axis[j]);
        }
        for (int k = 0; k < m; ++k) {
            if (!(t[k][k] > 0.0)) return Verdict::kUnsolved;
            const double over = 1.0 / t[k][k];
            for (int c = k + 1; c < m + 4; ++c) t[k][c] *= over;
            for (int j = 0; j < m; ++j)
                if (j != k)
                    for (int c = k + 1; c < m + 4; ++c) t[j][c] -= t[j][k] * t[k][c];
        }
        Vec u = table_.free[here];
        Mat w = table_.yields[here][here];
        for (int k = 0; k < m; ++k) {
            const Vec moved = answer(slot, k);
            u = u + t[k][m] * moved, w.a = w.a + t[k][m + 1] * moved, w.b = w.b + t[k][m + 2] * moved, w.c = w.c + t[k][m + 3] * moved;
        }
        const double mu = p_.friction, largest_yield = w.c.z + mu * std::sqrt(w.a.z * w.a.z + w.b.z * w.b.z);
        // tensile force for every direction
        if (!(largest_yield > 0.0) || u.z > largest_yield * limit_ * p_.body->mass) return Verdict::kExcluded;
        double r = 0.0, slope = 0.0, along = 0.0, normal = 0.0;
        const auto across = [&](Flat d) {
            // rate per unit normal force, and its derivative by the angle
            const Vec by = w.c - mu * (d.x * w.a + d.y * w.b), turn = -mu * (d.x * w.b - d.y * w.a);
            normal = -u.z / by.z;
            const double change = -normal * turn.z / by.z;
            const Vec slip = u + normal * by, slips = change * by + normal * turn;
            const double over = 1.0 / greater(soft_[0] * std::fabs(normal) + norm(slip), 1e-300);
            along = (d.x * slip.x + d.y * slip.y) * over, r = (d.x * slip.y - d.y * slip.x) * over;
            slope = (d.x * slips.y - d.y * slips.x) * over - along;
            return by.z > 0.0;
        };
        Flat d = t_.ways[slot];
        if (!across(d)) return Verdict::kUnsolved;
        for (int k = 0; k < kNewton; ++k) {
            if (std::fabs(r) <= kStraight) {
                if (!(along < -kStraight)) {
                    t_.ways[slot] = d;
                    return forces<n, rest>() ? done<n, rest>() : Verdict::kUnsolved;
                }
                d = {-d.x, -d.y};
                if (!across(d)) return Verdict::kUnsolved;
                continue;
            }
            const double before = std::fabs(r);
            double step = lesser(greater(-r / slope, -0.5), 0.5);
            if (!std::isfinite(step)) return Verdict::kUnsolved;
            const Flat begun = d;
            for (int tries = 0; tries < kTries; ++tries, step *= 0.5) {
                d = unit(Flat{begun.x - step * begun.y, begun.y + step * begun.x});
                if (!across(d)) return Verdict::kUnsolved;
                if (std::fabs(r) < before) break;
            }
        }
        return Verdict::kUnsolved;
    }

    template <int n, int rest>
    void write() {
        for (int k = 0; k < n; ++k) t_.force[k] = {-p_.friction * x_[k] * t_.ways[k].x, -p_.friction * x_[k] * t_.ways[k].y, x_[k]};
        if (rest) t_.force[one_].x = x_[n], t_.force[one_].y = x_[n + 1];
    }
    template <int n, int rest>
    Verdict done() {
        write<n, rest>();
        return Verdict::kSolved;
    }

    const Problem& p_;
    const Yields& table_;
    Trial& t_;
    int one_, count_, free_[3];
    double limit_, soft_[3], x_[5], by_[3][5];
    Vec effects_[5][3], turns_[3][3];
};

}  // namespace rocking::hull
