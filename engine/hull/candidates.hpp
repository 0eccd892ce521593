// Candidates for the contact set, solved when needed: sticking before sliding, larger faces before smaller faces,
// flight last.
#pragma once
#include <memory>
#include <optional>

#include "trial.hpp"

namespace rocking::hull {

using Moving = Few<Placed>;  // sliding vertices and their directions in body axes
inline const Vec* moving_of(const Moving& moving, int i) {
    for (const auto& entry : moving)
        if (entry.first == i) return &entry.second;
    return nullptr;
}

class Candidates {
  public:
    // Starts a problem; it must exist as long as its lists are used. limit: a candidate with a larger violation of a
    // law is rejected.
    void begin(const Problem& p, const Points& touching, const Points& near, const Moving& moving, double still, double limit) {
        problem_ = &p, near_ = &near, moving_ = &moving, still_ = still, limit_ = limit, next_ = 0;
        faces_.clear(), made_.clear(), holding_.clear(), table_.reset();
        add_faces(p, touching, near, faces_);
        holding_.resize(faces_.size());
        if (near.size() <= Yields::kMost && p.friction < kInfinite) table_.emplace(p, near);
        order();
        made_.reserve(ways_.size() + 1);
    }

    // The first candidate with a violation of at most `slack` for which `fits` is true; null if there is none.
    template <class Fits>
    const Solution* first(double slack, Fits fits) {
        for (std::size_t k = 0; at(k); ++k) {
            if (!(made_[k].excess <= slack)) continue;
            const Solution& s = solution(made_[k]);
            if (fits(s)) return &s;
        }
        return nullptr;
    }

    // The next candidate; null after the last candidate.
    const Solution* operator[](std::size_t k) { return at(k) ? &solution(made_[k]) : nullptr; }

    // All candidates from the start, invalid candidates included.
    void all() { limit_ = kInfinite, next_ = 0, made_.clear(); }

  private:
    enum : int { kAll = -2, kNobody = -1 };
    struct Way {
        std::size_t rank;
        int face, stuck;
    };
    struct Made {
        Way way;
        double excess;
        Trial trial;
        std::unique_ptr<Solution> solution;
    };
    struct Held {
        bool known = false, exists = false, few = false;
        Trial trial;                    // for up to three vertices
        std::unique_ptr<Solution> solution;
    };

    void order() {
        Few<std::size_t> from(3);  // by rank: index of the first candidate
        every_way([&](const Way& w) {
            if (from.size() < w.rank + 2) from.resize(w.rank + 2);
            ++from[w.rank + 1];
        });
        for (std::size_t k = 1; k < from.size(); ++k) from[k] += from[k - 1];
        ways_.resize(from.back());
        every_way([&](const Way& w) { ways_[from[w.rank]++] = w; });
    }

    template <class Take>
    void every_way(Take take) const {
        for (std::size_t f = 0; f < faces_.size(); ++f) {
            const Points& members = faces_[f];
            std::size_t n = 0;
            for (int i : members) n += !moving_of(*moving_, i);
            const auto add = [&](int stuck, std::size_t sticks) {
                // a facet on which all vertices slide precedes edges and single vertices
                if (problem_->friction < kInfinite || sticks == members.size()) take(Way{sticks == n ? 0 : members.size() > 2 && !sticks ? 1 : n - sticks + 1, static_cast<int>(f), stuck});
            };
            if (n == members.size() || n < 2) add(kAll, n);
            // two sticking vertices of a facet make the facet stick; for an edge, single vertices remain as candidates
            if (n > 1 && members.size() <= kCorners)
                for (int i : members)
                    if (!moving_of(*moving_, i)) add(i, 1);
            if (n > 0) add(kNobody, 0);
        }
    }

    bool at(std::size_t k) {
        while (made_.size() <= k && next_ <= ways_.size()) add();
        return k < made_.size();
    }

    void add() {
        if (next_++ == ways_.size()) return keep({0, -1, kNobody}, whole({}, {}));
        const Way& way = ways_[next_ - 1];
        const Points& members = faces_[way.face];
        const Held& held = hold(way.face);
        if (way.stuck == kAll) {
            if (!held.exists) return;
            if (!held.few) return keep(way, std::make_unique<Solution>(*held.solution));
            const unsigned sticking = moving_->empty() ? 7u : sticks(members);
            return keep(way, held.trial, excess(*problem_, *table_, held.trial, sticking));
        }
        if (table_ && members.size() <= Trial::kMost) {
            Trial t;
            if (slide(way, held, t) == Verdict::kSolved) keep(way, t, excess(*problem_, *table_, t, way.stuck == kNobody ? 0u : 1u << slot_of(members, way.stuck, 0)));
            return;
        }
        auto s = whole(members, way.stuck == kNobody ? Points{} : Points{way.stuck});
        if (sliding(*problem_, still_, pulls(held, members.size()), *s)) keep(way, std::move(s));
    }

    void keep(const Way& way, const Trial& trial, double excess) {
        if (excess <= limit_) made_.push_back({way, excess, trial, nullptr});
    }
    void keep(const Way& way, std::unique_ptr<Solution> s) {
        if (!s->exists && !solve(*problem_, *s)) return;
        const double violation = excess(*problem_, *s, *near_);
        made_.push_back({way, violation, {}, std::move(s)});
    }

    unsigned sticks(const Points& members) const {
        unsigned bits = 0;
        for (std::size_t k = 0; k < members.size(); ++k) bits |= static_cast<unsigned>(!moving_of(*moving_, members[k])) << k;
        return bits;
    }

    Trial begun(const Points& members) const {
        Trial t;
        t.n = static_cast<int>(members.size());
        for (int k = 0; k < t.n; ++k) {
            const Vec* d = moving_of(*moving_, members[k]);
            t.at[k] = table_->slot(members[k]);
            t.ways[k] = d ? Flat{dot(problem_->axes.a, *d), dot(problem_->axes.b, *d)} : Flat{};
        }
        return t;
    }

    // Candidates in which one free member of a face sticks, or no free member.
    Verdict slide(const Way& way, const Held& held, Trial& t) const {
        const Points& members = faces_[way.face];
        t = begun(members);
        int free[Trial::kMost], count = 0, stuck = -1;
        double soft[Trial::kMost];
        for (int k = 0; k < t.n; ++k) {
            if (members[k] == way.stuck) stuck = k, t.ways[k] = {};
            else if (!moving_of(*moving_, members[k])) free[count++] = k;
        }
        if (problem_->friction == 0.0) count = 0;
        const Vecs begin = pulls(held, members.size());
        for (int j = 0; j < count; ++j) {
            const Mat& w = problem_->body->soft[members[free[j]]];
            soft[j] = greater(dot(problem_->axes.a, w * problem_->axes.a), dot(problem_->axes.b, w * problem_->axes.b)) * problem_->friction * count;
            const Vec d = begin[free[j]];
            t.ways[free[j]] = unit(Flat{-dot(problem_->axes.a, d), -dot(problem_->axes.b, d)});
        }
        return Sliding(*problem_, *table_, t, stuck, free, count, soft, limit_).solve(still_);
    }

    std::unique_ptr<Solution> whole(const Points& members, const Points& stuck) const {
        auto s = std::make_unique<Solution>();
        s->contact = {members, stuck};
        s->directions.assign(members.size(), Vec{});
        for (std::size_t j = 0; j < members.size(); ++j) {
            const Vec* d = moving_of(*moving_, members[j]);
            if (d && !has(stuck, members[j])) s->directions[j] = *d;
        }
        return s;
    }

    // Adds a face; its vertices stick, except the vertices that already slide.
    const Held& hold(int face) {
        Held& held = holding_[face];
        if (held.known) return held;
        held.known = true;
        const Points& members = faces_[face];
        Points free;
        for (int i : members)
            if (!moving_of(*moving_, i)) free.push_back(i);
        if (table_ && members.size() <= Trial::kMost) {
            held.trial = begun(members);
            held.few = free.size() == members.size() ? stick(*problem_, *table_, held.trial) : false;
            if (!held.few && free.size() < 2 && free.size() < members.size()) {
                const int stuck = free.empty() ? -1 : static_cast<int>(slot_of(members, free[0], 0));
                const Verdict verdict = Sliding(*problem_, *table_, held.trial, stuck, nullptr, 0, nullptr, limit_).solve(still_);
                if (verdict == Verdict::kExcluded) return held;
                held.few = verdict == Verdict::kSolved;
            }
        }
        held.exists = held.few;
        if (!held.few) held.solution = whole(members, free), held.exists = solve(*problem_, *held.solution);
        return held;
    }

    Vecs pulls(const Held& held, std::size_t n) const {
        Vecs pulls(n);
        if (!held.exists) return pulls;
        if (!held.few) return held.solution->pulls;
        for (int k = 0; k < held.trial.n; ++k) pulls[k] = problem_->ground(held.trial.force[k].x, held.trial.force[k].y);
        return pulls;
    }

    const Solution& solution(Made& made) const {
        if (made.solution) return *made.solution;
        const Points& members = faces_[made.way.face];
        Points stuck;
        for (int i : members)
            if (made.way.stuck == i || (made.way.stuck == kAll && !moving_of(*moving_, i))) stuck.push_back(i);
        made.solution = whole(members, stuck);
        Solution& s = *made.solution;
        s.linear = problem_->linear, s.angular = problem_->angular;
        for (int k = 0; k < made.trial.n; ++k) {
            const Vec force = row_times(made.trial.force[k], problem_->axes);
            s.linear = s.linear + 1.0 / problem_->body->mass * force, s.angular = s.angular + problem_->body->inverse * cross(problem_->place(members[k]), force);
            s.normals.push_back(made.trial.force[k].z);
            s.pulls.push_back(has(stuck, members[k]) ? problem_->ground(made.trial.force[k].x, made.trial.force[k].y) : Vec{});
            if (!has(stuck, members[k])) s.directions[k] = problem_->ground(made.trial.ways[k].x, made.trial.ways[k].y);
        }
        s.exists = true;
        return s;
    }

    const Problem* problem_ = nullptr;
    const Points* near_ = nullptr;
    const Moving* moving_ = nullptr;
    double still_ = 0.0, limit_ = 0.0;
    std::vector<Points> faces_;
    std::vector<Held> holding_;
    std::vector<Way> ways_;
    std::vector<Made> made_;
    std::optional<Yields> table_;
    std::size_t next_ = 0;
};

}  // namespace rocking::hull
