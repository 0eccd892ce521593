// Impulses of a step: normal impulses at two corners and a friction impulse of each joint, by complementarity.
// The matrix is block tridiagonal with blocks of three rows. Statuses are exchanged until all conditions are satisfied; projected
// Gauss-Seidel follows where the exchange does not end.
#pragma once
#include <algorithm>

#include "chain.hpp"

namespace rocking::stack {

using Block = std::array<std::array<double, 3>, 3>;
using Three = std::array<double, 3>;

inline Three times(const Block& m, const Three& v) {
    Three r;
    for (int i = 0; i < 3; ++i) r[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
    return r;
}

struct Joint {
    Block own{}, below{}, above{};  // blocks of the matrix: this joint, the joint below, the joint above
    Three constant{};               // velocities without impulses, with the part of the step
    Three impulse{};                // left and right normal impulse, friction impulse
    double friction = 0.0;          // infinite for a joint that sticks
    bool active[2] = {true, true};
    int slides = 0;  // 0 sticks, 1 friction upwards along the face, -1 downwards
};

class Solver {
  public:
    std::int64_t unsolved = 0;

    void solve(std::vector<Joint>& joints, double tolerance) {
        double size = 0.0;
        for (const Joint& j : joints)
            for (int i = 0; i < 3; ++i) {
                if (i < 2 && j.constant[i] > 0.0) continue;  // an open corner far away
                size = std::max(size, std::fabs(j.constant[i]));
            }
        if (size == 0.0) {
            for (Joint& j : joints) j.impulse = {};
            return;
        }
        if (exchanged(joints, size, tolerance) || relax(joints, size, tolerance, kSweeps)) return;
        // Large friction can leave no solution (Painleve): the step has a friction of at most 1.
        ++unsolved;
        std::vector<double> stated;
        for (Joint& j : joints) stated.push_back(j.friction), j.friction = std::min(j.friction, 1.0);
        if (!exchanged(joints, size, tolerance)) relax(joints, size, tolerance, kSweeps);
        for (std::size_t k = 0; k < joints.size(); ++k) joints[k].friction = stated[k];
    }

  private:
    bool exchanged(std::vector<Joint>& joints, double size, double tolerance) {
        for (int start = 0; start < kStarts; ++start) {  // statuses of the last step, all in contact, none, those of some sweeps
            if (start == 1 || start == 2)
                for (Joint& j : joints) j.active[0] = j.active[1] = start == 1, j.slides = 0;
            if (start == 3) relax(joints, size, tolerance, kFew);
            for (int turn = 0; turn < kExchanges; ++turn) {
                if (!equalities(joints)) break;
                if (!exchange(joints, size, tolerance, turn >= kTogether)) return true;
            }
        }
        return false;
    }

    static constexpr int kStarts = 4, kExchanges = 40, kTogether = 12, kFew = 200, kSweeps = 20000;
    std::vector<Block> upper_;
    std::vector<Three> right_;

    // Solves the conditions of the statuses: velocity zero of active corners and of sticking joints, impulse zero of inactive corners.
    bool equalities(std::vector<Joint>& joints) {
        const std::size_t n = joints.size();
        upper_.resize(n), right_.resize(n);
        for (std::size_t k = 0; k < n; ++k) {
            const Joint& j = joints[k];
            Block m = j.own, lower = j.below, upper = j.above;
            Three b{-j.constant[0], -j.constant[1], -j.constant[2]};
            const auto only = [&](int i, Three row) { m[i] = row, lower[i] = upper[i] = {}, b[i] = 0.0; };
            for (int i = 0; i < 2; ++i)
                if (!j.active[i]) only(i, {i == 0 ? 1.0 : 0.0, i == 1 ? 1.0 : 0.0, 0.0});
            if (!j.active[0] && !j.active[1]) only(2, {0.0, 0.0, 1.0});
            else if (j.slides) only(2, {-j.slides * j.friction, -j.slides * j.friction, 1.0});
            if (k) {
                for (int i = 0; i < 3; ++i) {
                    for (int l = 0; l < 3; ++l) b[i] -= lower[i][l] * right_[k - 1][l];
                    Three row{};
                    for (int l = 0; l < 3; ++l)
                        for (int c = 0; c < 3; ++c) row[c] += lower[i][l] * upper_[k - 1][l][c];
                    for (int c = 0; c < 3; ++c) m[i][c] -= row[c];
                }
            }
            eliminate(m, upper, b);
            upper_[k] = upper, right_[k] = b;
        }
        for (std::size_t k = n; k-- > 0;) {
            joints[k].impulse = right_[k];
            if (k + 1 < n) {
                const Three next = times(upper_[k], joints[k + 1].impulse);
                for (int i = 0; i < 3; ++i) joints[k].impulse[i] -= next[i];
            }
            for (double p : joints[k].impulse)
                if (!std::isfinite(p)) return false;
        }
        return true;
    }

    // Solves the three rows for the block to the right and the right side, with the largest pivots.
    static void eliminate(Block m, Block& right, Three& b) {
        for (int k = 0; k < 3; ++k) {
            int top = k;
            for (int i = k + 1; i < 3; ++i)
                if (std::fabs(m[i][k]) > std::fabs(m[top][k])) top = i;
            std::swap(m[k], m[top]), std::swap(right[k], right[top]), std::swap(b[k], b[top]);
            for (int i = 0; i < 3; ++i) {
                if (i == k || m[i][k] == 0.0) continue;
                const double f = m[i][k] / m[k][k];
                for (int c = k; c < 3; ++c) m[i][c] -= f * m[k][c];
                for (int c = 0; c < 3; ++c) right[i][c] -= f * right[k][c];
                b[i] -= f * b[k];
            }
        }
        for (int k = 0; k < 3; ++k) {
            for (int c = 0; c < 3; ++c) right[k][c] /= m[k][k];
            b[k] /= m[k][k];
        }
    }

    static double velocity(const std::vector<Joint>& joints, std::size_t k, int i) {
        const Joint& j = joints[k];
        double v = j.constant[i];
        for (int c = 0; c < 3; ++c) {
            v += j.own[i][c] * j.impulse[c];
            if (k) v += j.below[i][c] * joints[k - 1].impulse[c];
            if (k + 1 < joints.size()) v += j.above[i][c] * joints[k + 1].impulse[c];
        }
        return v;
    }

    // Changes the statuses whose conditions are violated: all, or the first. Returns false if all conditions are satisfied.
    static bool exchange(std::vector<Joint>& joints, double size, double tolerance, bool single) {
        double largest = 0.0;
        for (const Joint& j : joints)
            for (double p : j.impulse) largest = std::max(largest, std::fabs(p));
        const double low = tolerance * largest, slow = tolerance * size;
        bool changed = false;
        for (std::size_t k = 0; k < joints.size() && !(single && changed); ++k) {
            Joint& j = joints[k];
            for (int i = 0; i < 2; ++i) {
                const bool wrong = j.active[i] ? j.impulse[i] < -low : velocity(joints, k, i) < -slow;
                if (!wrong) continue;
                j.active[i] = !j.active[i], changed = true;
                if (single) return true;
            }
            if (!j.active[0] && !j.active[1]) {
                j.slides = 0;
                continue;
            }
            const double bound = j.friction * (j.impulse[0] + j.impulse[1]);  // Eq. 380
            if (j.slides == 0) {
                if (std::fabs(j.impulse[2]) > bound + low && bound >= 0.0) j.slides = j.impulse[2] > 0.0 ? 1 : -1, changed = true;
            } else if (j.slides * velocity(joints, k, 2) > slow) {
                j.slides = 0, changed = true;
            }
        }
        return changed;
    }

    // Projected Gauss-Seidel: the conditions of one impulse after the other.
    bool relax(std::vector<Joint>& joints, double size, double tolerance, int most) {
        double worst = 0.0;
        for (Joint& j : joints)
            for (int i = 0; i < 3; ++i) j.impulse[i] = !std::isfinite(j.impulse[i]) ? 0.0 : i < 2 ? std::max(j.impulse[i], 0.0) : j.impulse[i];
        for (int sweep = 0; sweep < most; ++sweep) {
            worst = 0.0;
            for (std::size_t k = 0; k < joints.size(); ++k) {
                Joint& j = joints[k];
                for (int i = 0; i < 3; ++i) {
                    const double old = j.impulse[i], bound = j.friction * (j.impulse[0] + j.impulse[1]);
                    double next = old - velocity(joints, k, i) / j.own[i][i];
                    if (i < 2) next = std::max(next, 0.0);
                    else next = j.impulse[0] + j.impulse[1] > 0.0 ? std::clamp(next, -bound, bound) : 0.0;
                    j.impulse[i] = next;
                    worst = std::max(worst, std::fabs(next - old) * j.own[i][i]);
                }
            }
            if (worst <= tolerance * size) break;
        }
        for (Joint& j : joints) {
            for (int i = 0; i < 2; ++i) j.active[i] = j.impulse[i] > 0.0;
            const double bound = j.friction * (j.impulse[0] + j.impulse[1]);
            j.slides = bound > 0.0 && std::fabs(j.impulse[2]) >= bound * (1.0 - 1e-9) ? (j.impulse[2] > 0.0 ? 1 : -1) : 0;
        }
        return worst <= tolerance * size;
    }
};

}  // namespace rocking::stack
