// Forces or impulses on a set of touching vertices. Accelerations and velocities lead to the same problem.
#pragma once
#include "body.hpp"

namespace rocking::hull {

constexpr double kSingular = 1e-12, kStraight = 1e-12;
constexpr int kTurns = 60, kNewton = 20, kTries = 6;
constexpr double kNearly = 1e-2;  // if the directions change by less, Newton's method starts
constexpr double kSwing = 1e-7;  // angle by which a direction is turned to compute a derivative
constexpr int kBegin = 6;  // iterations before Newton's method for a facet with many corners
constexpr std::size_t kCorners = 8;  // no single vertex sticks on a facet with more corners

struct Contact {
    Points members, stuck;
    bool operator==(const Contact& o) const { return members == o.members && stuck == o.stuck; }
};

// Index of a member in the list of members. The search starts at `from`, since parallel lists have the same order.
inline std::size_t slot_of(const Points& members, int i, std::size_t from) {
    for (std::size_t k = from; k < members.size(); ++k)
        if (members[k] == i) return k;
    return static_cast<std::size_t>(std::find(members.begin(), members.end(), i) - members.begin());
}

inline bool has(const Points& all, int i) { return std::find(all.begin(), all.end(), i) != all.end(); }

struct Placed {
    int first;
    Vec second;
};

// Motion without contact forces, and points at which the forces act.
struct Problem {
    const Body* body = nullptr;
    Mat axes;
    Vec linear, angular, spin;
    double friction = 0.0;
    // true for accelerations, which include the centripetal part; false for velocities
    bool forces = false;
    // points where the impulses of vertices act, if these points are not the vertices
    Few<Placed> places;

    Vec bias(int i) const { return cross(spin, cross(spin, body->points[i])); }
    Vec rate(int i, Vec a, Vec alpha) const {
        const Vec free = a + cross(alpha, body->points[i]);  // Eq. 250
        return forces ? free + bias(i) : free;
    }
    Vec place(int i) const {
        for (const auto& [k, at] : places)
            if (k == i) return at;
        return body->points[i];
    }
    Vec ground(double x, double y) const { return x * axes.a + y * axes.b; }
};

// Motion and forces of a candidate; lists correspond to the members of the contact.
struct Solution {
    Contact contact;
    Vec linear, angular;
    Numbers normals;
    double shape[3];  // coefficients of the distribution of more than three normal forces
    // directions of the sliding members, tangential forces of the sticking members; zero for the others
    Vecs directions, pulls;
    bool exists = false;
};

struct Wrench {
    Vec f, m;
};

// Gauss elimination without row exchange; false if a pivot is not positive, since then no force produces the motion.
template <int n>
bool eliminated(double (&t)[n][n + 1], const double* thresholds, double* answer) {
    for (int k = 0; k < n; ++k) {
        if (!(t[k][k] > thresholds[k])) return false;
        for (int j = k + 1; j < n; ++j) {
            const double factor = t[j][k] / t[k][k];
            if (factor != 0.0)
                for (int c = k + 1; c <= n; ++c) t[j][c] -= factor * t[k][c];
        }
    }
    for (int k = n - 1; k >= 0; --k) {
        double total = t[k][n];
        for (int c = k + 1; c < n; ++c) total -= t[k][c] * answer[c];
        answer[k] = total / t[k][k];
    }
    return true;
}

template <int n>
bool answered(const Problem& p, const Wrench* columns, const Wrench* rows, const double* offsets, double* answer) {
    double t[n][n + 1], sizes[n];
    Wrench soft[n];
    for (int c = 0; c < n; ++c) soft[c] = {1.0 / p.body->mass * columns[c].f, p.body->inverse * columns[c].m};
    for (int r = 0; r < n; ++r) {
        for (int c = 0; c < n; ++c) t[r][c] = dot(rows[r].f, soft[c].f) + dot(rows[r].m, soft[c].m);
        t[r][n] = -(dot(rows[r].f, p.linear) + dot(rows[r].m, p.angular) + offsets[r]);  // Eq. 252
        sizes[r] = kSingular * t[r][r];
    }
    return eliminated<n>(t, sizes, answer);
}

// Divides the tangential forces of sticking vertices in proportion to normal forces and resistance to rotation.
inline void share_pulls(const Problem& p, const double* parts, Solution& s) {
    const Points& stuck = s.contact.stuck;
    const int n = static_cast<int>(stuck.size());
    s.pulls.assign(s.contact.members.size(), Vec{});
    if (!n) return;
    std::size_t from = 0;
    const auto slot = [&](int i) {
        const std::size_t index = slot_of(s.contact.members, i, from);
        return from = index + 1, index;
    };
    const Vec total = p.ground(parts[0], parts[1]), up = p.axes.c;
    if (n == 1) {
        s.pulls[slot(stuck[0])] = total;
        return;
    }
    Numbers weights(n);
    Vecs arms(n), turning(n);
    double weight = 0.0;
    for (int k = 0; k < n; ++k) arms[k] = p.place(stuck[k]), weight += weights[k] = greater(s.normals[slot(stuck[k])], 0.0);
    if (!(weight > 0.0)) weights.assign(n, 1.0), weight = n;
    Vec loaded, even;
    for (int k = 0; k < n; ++k) loaded = loaded + weights[k] / weight * arms[k], even = even + 1.0 / n * arms[k];
    const double couple = parts[2] + dot(up, cross(even - loaded, total));
    double resistance = 0.0;
    for (int k = 0; k < n; ++k) turning[k] = cross(up, arms[k] - loaded), resistance += weights[k] * dot(turning[k], turning[k]);
    const double rate = resistance > 0.0 ? couple / resistance : 0.0;
    for (int k = 0; k < n; ++k) turning[k] = weights[k] * (1.0 / weight * total + rate * turning[k]);  // Eq. 255
    if (n == 2) {
        const Vec along = unit(arms[1] - arms[0]);
        double room[2], whole = 0.0;
        Vec across[2];
        for (int k = 0; k < 2; ++k) {
            across[k] = turning[k] - dot(turning[k], along) * along;
            const double most = p.friction * weights[k];
            whole += room[k] = std::sqrt(greater(most * most - dot(across[k], across[k]), 0.0));  // Eq. 256
        }
        if (whole > 0.0)
            for (int k = 0; k < 2; ++k) turning[k] = across[k] + room[k] / whole * dot(total, along) * along;
    }
    for (int k = 0; k < n; ++k) s.pulls[slot(stuck[k])] = turning[k];
}

template <int size>  // size: number of equations of the system
bool linear_of(const Problem& p, const Points& carrying, Solution& s) {
    const Body& body = *p.body;
    const Points &members = s.contact.members, &stuck = s.contact.stuck;
    const Vec up = p.axes.c;
    const int n = static_cast<int>(carrying.size()), shapes = n <= 3 ? n : 3, rest = static_cast<int>(stuck.size());
    Wrench columns[size], rows[size];
    double offsets[size] = {}, answer[size];
    const auto weights = [&](int k, Vec at, double* w) {  // weights of the distributions at a loaded vertex
        if (n > 3) w[0] = 1.0, w[1] = dot(p.axes.a, at), w[2] = dot(p.axes.b, at);  // Eq. 253
        else w[0] = w[1] = w[2] = 0.0, w[k] = 1.0;
    };
    constexpr int most = size < 3 ? size : 3;
    double w[3];
    for (int k = 0; k < n; ++k) {
        const int i = members[carrying[k]];
        const Vec at = p.place(i), slide = s.directions[carrying[k]];
        const Vec push = dot(slide, slide) > 0.0 ? up - p.friction * slide : up, turn = cross(at, push), lift = cross(body.points[i], up);
        const double swing = p.forces ? dot(up, p.bias(i)) : 0.0;
        weights(k, at, w);
        for (int j = n > 3 ? 0 : k, end = n > 3 ? most : std::min(k + 1, most); j < end; ++j) {
            columns[j].f = columns[j].f + w[j] * push, columns[j].m = columns[j].m + w[j] * turn;
            rows[j].f = rows[j].f + w[j] * up, rows[j].m = rows[j].m + w[j] * lift;
            offsets[j] += w[j] * swing;
        }
    }
    if (size > 2 && rest) {
        int at = shapes;
        // means over the sticking vertices; the matrix is symmetric if the forces act at the vertices
        Vec acts, moves, known_there;
        const double share = 1.0 / rest;
        for (int i : stuck) {
            acts = acts + share * p.place(i), moves = moves + share * body.points[i];
            if (p.forces) known_there = known_there + share * p.bias(i);
        }
        for (const Vec axis : {p.axes.a, p.axes.b}) {
            columns[at] = {axis, cross(acts, axis)}, rows[at] = {axis, cross(moves, axis)};
            offsets[at++] = dot(axis, known_there);
        }
        if (size > 3 && rest > 1) {
            const int first = stuck[0], other = stuck[rest / 2];
            const Vec arm = body.points[other] - body.points[first], across = cross(up, arm);
            columns[at] = rows[at] = {{}, up};
            offsets[at++] = p.forces ? dot(across, p.bias(other) - p.bias(first)) / dot(across, across) : 0.0;
        }
    }
    if (!answered<size>(p, columns, rows, offsets, answer)) return false;
    Vec force, moment;
    for (int k = 0; k < size; ++k) force = force + answer[k] * columns[k].f, moment = moment + answer[k] * columns[k].m;
    s.linear = p.linear + 1.0 / body.mass * force;
    s.angular = p.angular + body.inverse * moment;
    s.normals.assign(members.size(), 0.0);
    for (int j = 0; j < most; ++j) s.shape[j] = answer[j];
    for (int k = 0; k < n; ++k) {
        weights(k, p.place(members[carrying[k]]), w);
        for (int j = n > 3 ? 0 : k, end = n > 3 ? most : std::min(k + 1, most); j < end; ++j) s.normals[carrying[k]] += answer[j] * w[j];
    }
    if (p.friction < kInfinite) share_pulls(p, answer + shapes, s);
    else s.pulls.assign(members.size(), Vec{});
    return true;
}

// Solution with forces at the `carrying` members, possibly tensile, that keeps the vertices of s.contact on the ground.
inline bool linear(const Problem& p, const Points& carrying, Solution& s) {
    const std::size_t shapes = std::min<std::size_t>(carrying.size(), 3), rest = s.contact.stuck.size();
    switch (shapes + (rest > 0 ? 2 : 0) + (rest > 1 ? 1 : 0)) {
        case 1: return linear_of<1>(p, carrying, s);
        case 2: return linear_of<2>(p, carrying, s);
        case 3: return linear_of<3>(p, carrying, s);
        case 4: return linear_of<4>(p, carrying, s);
        case 5: return linear_of<5>(p, carrying, s);
        default: return linear_of<6>(p, carrying, s);
    }
}

// Accelerations and forces of s.contact with the directions s.directions.
inline bool solve(const Problem& p, Solution& s) {
    if (s.contact.members.empty()) {
        s.linear = p.linear, s.angular = p.angular, s.normals.clear(), s.pulls.clear();
        return s.exists = true;
    }
    Points carrying(s.contact.members.size());
    for (std::size_t k = 0; k < carrying.size(); ++k) carrying[k] = static_cast<int>(k);
    const Points all = carrying;
    Points next;
    // iterates to the vertices at which a linear pressure is positive
    for (int turn = 0; all.size() > kCorners && turn < kNewton; ++turn) {
        if (!(s.exists = linear(p, carrying, s))) break;
        next.clear();
        for (int k : all) {
            const Vec at = p.place(s.contact.members[k]);
            if (s.shape[0] + s.shape[1] * dot(p.axes.a, at) + s.shape[2] * dot(p.axes.b, at) >= 0.0) next.push_back(k);
        }
        if (next == carrying) return true;
        if (next.size() <= 3) break;
        carrying = next;
    }
    carrying = all;
    for (;;) {
        s.exists = linear(p, carrying, s);
        if (!s.exists || s.contact.members.size() <= 3) return s.exists;
        const std::size_t before = carrying.size();
        for (std::size_t out = std::max<std::size_t>(before / 16, 1); out && carrying.size() > 3; --out) {
            auto weakest = carrying.begin();
            for (auto k = carrying.begin(); k != carrying.end(); ++k)
                if (s.normals[*k] < s.normals[*weakest]) weakest = k;
            if (s.normals[*weakest] >= 0.0) break;
            carrying.erase(weakest);
        }
        if (carrying.size() == before) return true;
    }
}

// Gauss elimination with row exchange; false if the matrix is singular. The last column: right-hand side, then the
// solution.
inline bool solved(int n, double t[][kCorners + 1]) {
    for (int k = 0; k < n; ++k) {
        int best = k;
        for (int i = k + 1; i < n; ++i)
            if (std::fabs(t[i][k]) > std::fabs(t[best][k])) best = i;
        if (!(std::fabs(t[best][k]) > kSingular)) return false;
        for (int c = 0; c <= n; ++c) std::swap(t[k][c], t[best][c]);
        for (int i = 0; i < n; ++i) {
            const double factor = i == k ? 0.0 : t[i][k] / t[k][k];
            for (int c = k; c <= n && factor != 0.0; ++c) t[i][c] -= factor * t[k][c];
        }
    }
    for (int k = 0; k < n; ++k) t[k][n] /= t[k][k];
    return true;
}

struct Flat {
    double x = 0.0, y = 0.0;
};

inline Flat unit(Flat a) {
    const double size = std::sqrt(a.x * a.x + a.y * a.y);
    return size > 0.0 ? Flat{a.x / size, a.y / size} : Flat{};
}

// Contact for the directions of sliding.
class Rubbing {
  public:
    Few<Flat> ways;  // directions by member, in axes of the ground

    Rubbing(const Problem& p, Solution& s) : p_(p), s_(s) {
        for (const Vec& d : s.directions) ways.push_back({dot(d, p.axes.a), dot(d, p.axes.b)});
    }

    // Computes normal forces and rates for the directions `ways`.
    bool act() {
        for (std::size_t k = 0; k < ways.size(); ++k) s_.directions[k] = p_.ground(ways[k].x, ways[k].y);
        return solve(p_, s_);
    }
    double normal(int k) const { return s_.normals[k]; }
    Vec rate(int k) const { return p_.axes * p_.rate(s_.contact.members[k], s_.linear, s_.angular); }

  private:
    const Problem& p_;
    Solution& s_;
};

// Newton's method: rotates the directions of vertices that start to slide to the directions of their accelerations.
inline bool turned(const Points& free, const Numbers& soft, Rubbing& rub) {
    const int n = static_cast<int>(free.size());
    Flat from[kCorners];
    double along[kCorners], r[kCorners], other[kCorners], table[kCorners][kCorners + 1], size = 0.0;
    // accelerations perpendicular to the directions, divided by the largest acceleration that friction causes
    const auto across = [&](double* r) {
        if (!rub.act()) return false;
        size = 0.0;
        for (int j = 0; j < n; ++j) {
            const Vec rate = rub.rate(free[j]);
            const Flat d = rub.ways[free[j]];
            const double over = 1.0 / greater(soft[j] * std::fabs(rub.normal(free[j])) + norm(rate), 1e-300);
            r[j] = (d.x * rate.y - d.y * rate.x) * over, along[j] = (d.x * rate.x + d.y * rate.y) * over;
            size = greater(size, std::fabs(r[j]));
        }
        return true;
    };
    if (!across(r)) return false;
    for (int k = 0; k < kNewton; ++k) {
        if (size <= kStraight) {
            bool with = true;
            for (int j = 0; j < n; ++j)
                if (along[j] < -kStraight) rub.ways[free[j]] = {-rub.ways[free[j]].x, -rub.ways[free[j]].y}, with = false;
            if (with) return rub.act();
            if (!across(r)) return false;
            continue;
        }
        const double before = size;
        for (int j = 0; j < n; ++j) from[j] = rub.ways[free[j]], table[j][n] = -r[j];
        for (int j = 0; j < n; ++j) {
            rub.ways[free[j]] = {from[j].x - kSwing * from[j].y, from[j].y + kSwing * from[j].x};
            if (!across(other)) return false;
            rub.ways[free[j]] = from[j];
            for (int i = 0; i < n; ++i) table[i][j] = (other[i] - r[i]) / kSwing;
        }
        if (!solved(n, table)) return false;
        double most = 0.0;
        for (int j = 0; j < n; ++j) most = greater(most, std::fabs(table[j][n]));
        double share = lesser(1.0, 0.5 / greater(most, 1e-300));
        for (int tries = 0; tries < kTries; ++tries, share *= 0.5) {
            for (int j = 0; j < n; ++j) {
                const double c = std::cos(share * table[j][n]), s = std::sin(share * table[j][n]);
                rub.ways[free[j]] = {c * from[j].x - s * from[j].y, c * from[j].y + s * from[j].x};
            }
            if (!across(r)) return false;
            if (size < before) break;
        }
    }
    return false;
}

// The same for a facet with many corners that starts to slide as a rigid body. Unknowns: two accelerations and a
// rotation.
inline bool turned_whole(const Problem& p, const Points& free, double still, Solution& s) {
    const Points& members = s.contact.members;
    const Vecs begun = s.directions;
    // directions, and the motion of the body for these directions; lengths are divided by the size of the body
    const auto follow = [&](const double* u) {
        for (int k : free) {
            const Vec r = p.body->points[members[k]], turn = u[2] / p.body->size * cross(p.axes.c, r);
            Vec rate = p.ground(u[0], u[1]) + turn;
            if (p.forces) rate = rate + p.bias(members[k]);
            rate = rate - dot(rate, p.axes.c) * p.axes.c;
            s.directions[k] = unit(rate + greater(still - norm(rate), 0.0) * begun[k]);
        }
        return solve(p, s);
    };
    const auto read = [&](double* u) { u[0] = dot(p.axes.a, s.linear), u[1] = dot(p.axes.b, s.linear), u[2] = p.body->size * dot(p.axes.c, s.angular); };
    double u[3], to[3], r[3], other[3], table[kCorners][kCorners + 1];
    const auto size_of = [](const double* a) { return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]); };
    const auto beside = [&](const double* at, double* off) {
        if (!follow(at)) return false;
        read(off);
        for (int j = 0; j < 3; ++j) off[j] -= at[j];
        return true;
    };
    read(u);
    if (!beside(u, r)) return false;
    for (int k = 0; k < 2 * kNewton; ++k) {
        const double size = size_of(r), large = size_of(u);
        if (size <= kStraight * large) return true;
        for (int j = 0; j < 3; ++j) {
            const double by = kSwing * greater(large, still), kept = u[j];
            u[j] += by;
            if (!beside(u, other)) return false;
            u[j] = kept;
            for (int i = 0; i < 3; ++i) table[i][j] = (other[i] - r[i]) / by;
            table[j][3] = -r[j];
        }
        if (!solved(3, table)) return false;
        double share = 1.0;
        for (int tries = 0; tries < 2 * kTries; ++tries, share *= 0.5) {
            for (int j = 0; j < 3; ++j) to[j] = u[j] + share * table[j][3];
            if (!beside(to, r)) return false;
            if (size_of(r) < size) break;
        }
        std::copy(to, to + 3, u);
    }
    return size_of(r) <= greater(still, 1e-9 * size_of(u));  // accelerations below `still` have no direction
}

// Solves the contact and iterates the directions in which free vertices start to slide. s.directions: directions of the
// sliding vertices. still: limit of the slip rate; below this limit friction alone determines the direction. pulls:
// vectors opposite to the first directions of the free vertices.
inline bool sliding(const Problem& p, double still, const Vecs& pulls, Solution& s) {
    const Points& members = s.contact.members;
    Points free;
    for (std::size_t k = 0; k < members.size(); ++k)
        if (!(dot(s.directions[k], s.directions[k]) > 0.0) && !has(s.contact.stuck, members[k])) free.push_back(static_cast<int>(k));
    if (free.empty() || p.friction == 0.0) return solve(p, s);
    for (int k : free) s.directions[k] = unit(-1.0 * pulls[k]);
    const std::size_t n = free.size();
    Numbers soft;
    for (int k : free) {
        const Mat& w = p.body->soft[members[k]];
        soft.push_back(greater(dot(p.axes.a, w * p.axes.a), dot(p.axes.b, w * p.axes.b)) * p.friction * static_cast<double>(n));
    }
    Rubbing rub(p, s);
    const Few<Flat> begun = rub.ways;
    if (n <= 2 && turned(free, soft, rub)) return true;
    rub.ways = begun;
    Few<Flat> after(n), moved(n), last(n);
    double nearly = kNearly;
    for (int turn = 0; turn < kTurns; ++turn) {
        if (!rub.act()) return false;
        if (n > kCorners && turn == kBegin) return turned_whole(p, free, still, s);
        double change = 0.0, along = 0.0, square = 0.0;
        for (std::size_t j = 0; j < n; ++j) {
            const Vec slip = rub.rate(free[j]);
            const Flat before = rub.ways[free[j]];
            const bool only_starts = std::sqrt(slip.x * slip.x + slip.y * slip.y) <= still && before.x * before.x + before.y * before.y > 0.0;
            const double push = soft[j] * greater(rub.normal(free[j]), 0.0);
            after[j] = only_starts ? before : unit(Flat{slip.x + push * before.x, slip.y + push * before.y});  // Eq. 257
            moved[j] = {after[j].x - before.x, after[j].y - before.y};
            change = greater(change, std::sqrt(moved[j].x * moved[j].x + moved[j].y * moved[j].y));
            along += moved[j].x * last[j].x + moved[j].y * last[j].y, square += last[j].x * last[j].x + last[j].y * last[j].y;
        }
        if (change <= kStraight) return rub.act();
        if (change <= nearly && n <= kCorners) {
            const Few<Flat> reached = rub.ways;
            for (std::size_t j = 0; j < n; ++j) rub.ways[free[j]] = after[j];
            if (turned(free, soft, rub)) return true;
            rub.ways = reached, nearly = 0.0;
        }
        // every third iteration extrapolates the last two changes as a geometric series (Aitken)
        const double ratio = turn % 3 == 2 && square > 0.0 ? along / square : 0.0;
        const double further = std::fabs(ratio) < 0.98 ? ratio / (1.0 - ratio) : 0.0;
        for (std::size_t j = 0; j < n; ++j)
            rub.ways[free[j]] = further != 0.0 ? unit(Flat{after[j].x + further * moved[j].x, after[j].y + further * moved[j].y}) : after[j];
        last = moved;
    }
    rub.ways = begun;
    return s.exists = n > 2 && n <= kCorners && turned(free, soft, rub);
}

// The vertices of the convex hull of points on the ground, in order (Andrew's monotone chain).
inline Points outline(const Problem& p, const Points& touching) {
    struct At {
        double x, y;
        int i;
    };
    Few<At> places, kept;
    for (int i : touching) places.push_back({dot(p.axes.a, p.body->points[i]), dot(p.axes.b, p.body->points[i]), i});
    std::sort(places.begin(), places.end(), [](const At& a, const At& b) { return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.i < b.i; });
    Points points;
    if (places.size() < 3) {
        for (const At& at : places) points.push_back(at.i);
        return points;
    }
    const double slack = 1e-10 * p.body->size * p.body->size;
    for (int pass = 0; pass < 2; ++pass) {
        kept.clear();
        for (const At& at : places) {
            while (kept.size() > 1) {
                const At &a = kept[kept.size() - 2], &b = kept.back();
                if ((b.x - a.x) * (at.y - a.y) - (b.y - a.y) * (at.x - a.x) > slack) break;
                kept.pop_back();
            }
            kept.push_back(at);
        }
        for (std::size_t k = 0; k + 1 < kept.size(); ++k) points.push_back(kept[k].i);
        std::reverse(places.begin(), places.end());
    }
    return points;
}

// Adds the possible contact sets: all touching vertices, edges of their border, single vertices. staying: vertices that
// do not leave. A chord with vertices beyond it is not an edge.
inline void add_faces(const Problem& p, const Points& touching, const Points& staying, std::vector<Points>& faces) {
    const Points border = outline(p, touching);
    const std::size_t n = border.size();
    faces.reserve(2 * n + 1);
    const bool all = staying.size() == touching.size();
    Few<char> stays(n, 1);
    for (std::size_t k = 0; k < n && !all; ++k) stays[k] = has(staying, border[k]);
    if (n > 2 && std::find(stays.begin(), stays.end(), 0) == stays.end()) faces.push_back(border);
    if (n > 1)
        for (std::size_t k = 0; k < (n > 2 ? n : 1); ++k)
            if (stays[k] && stays[(k + 1) % n]) faces.push_back({border[k], border[(k + 1) % n]});
    for (std::size_t k = 0; k < n; ++k)
        if (stays[k]) faces.push_back({border[k]});
}
inline std::vector<Points> faces(const Problem& p, const Points& touching) {
    std::vector<Points> faces;
    add_faces(p, touching, touching, faces);
    return faces;
}

// True if no gap closes.
inline bool clear(const Problem& p, const Solution& s, const Points& touching, double slack) {
    const Points& members = s.contact.members;
    if (members.size() > 2 && members.size() == touching.size()) return true;  // all touching vertices stay
    for (int i : touching)
        if (dot(p.axes.c, p.rate(i, s.linear, s.angular)) < -slack && !has(members, i)) return false;
    return true;
}

// Largest violation of a law, over the mass; with this or a larger slack the solution is valid.
inline double excess(const Problem& p, const Solution& s, const Points& touching) {
    const double light = 1.0 / p.body->mass, mu = p.friction;
    const Points& members = s.contact.members;
    double most = -kInfinite;
    for (std::size_t k = 0; k < s.normals.size(); ++k) {
        most = greater(most, -light * s.normals[k]);
        if (mu < kInfinite && has(s.contact.stuck, members[k])) most = greater(most, light / (1.0 + mu) * (norm(s.pulls[k]) - mu * s.normals[k]));
    }
    if (members.size() > 2 && members.size() == touching.size()) return most;  // all touching vertices stay
    for (int i : touching)
        if (!has(members, i)) most = greater(most, -dot(p.axes.c, p.rate(i, s.linear, s.angular)));
    return most;  // Eq. 251
}

}  // namespace rocking::hull
