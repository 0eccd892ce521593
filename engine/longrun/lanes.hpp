// Taylor steps of many histories in parallel; when the history of a lane ends, the lane takes the next row.
#pragma once
#include "lane.hpp"

namespace rocking::ROCKING_ISA::longrun {

#define ROCKING_LANES ROCKING_UNROLL for (int j = 0; j < U; ++j)

// V: number of tangent vectors. Driver starts and ends the histories and stores their results.
template <int V, class Driver>
class Lanes {
    // registers that are computed in parallel, their width, number of lanes
    static constexpr int U = 2, P = Pack::width, W = U * P;
    using Row = Pack[U];
    const Driver driver;
    const Settings& set = driver.work.set;
    Queue& queue;
    Lane<V> lane[W];
    alignas(64) double h[W], start[W], rate[W], alpha[W], p2[W], side[W], ends[W], rates[W], bends[W];
    alignas(64) double angle[kMostSines][W], flip[kMostSines][W], amplitude[kMostSines][W], omega[kMostSines][W], time[W];
    alignas(64) double tangent[V > 0 ? V : 1][2][W];
    alignas(64) Pack c[kTerms][U], u[kTerms][U], S[kTerms][U], C[kTerms][U], F[kTerms][U], G[kTerms][U], w[kTerms][U], d[V > 0 ? V : 1][kTerms][U];
    alignas(64) Pack by[kTerms][U];  // derivative of the ground acceleration by a frequency

  public:
    Lanes(const Driver& rows, Queue& rest) : driver(rows), queue(rest) {}

    void run() {
        for (int i = 0; i < W; ++i) ready(i);
        for (;;) {
            int active = -1;
            for (int i = 0; i < W; ++i) active = lane[i].row >= 0 ? i : active;
            if (active < 0) return;
            gather(lane[active]);
            series();
            lengths();
            advance();
            for (int i = 0; i < W; ++i)
                if (lane[i].row >= 0) finish(i);
        }
    }

  private:
    // Advances a lane to its next regular step: handles rest, ends of periods and new rows.
    void ready(int i) {
        Lane<V>& one = lane[i];
        for (;;) {
            if (one.row < 0 && !begin(one)) return;
            if (one.resting) one.wait();
            if (one.t < one.until && !one.resting) return;
            if (!driver.arrived(one)) one.row = -1;
        }
    }

    bool begin(Lane<V>& one) {
        const std::int64_t row = queue.fetch_add(1);
        if (row >= driver.work.count) return false;
        one.begin(driver.work.bodies + kBody * row, driver.work.sines + set.sines * row, set);
        one.row = row;
        one.t = driver.work.starts[kStart * row];
        driver.begin(one);
        return true;
    }

    void gather(const Lane<V>& other) {
        for (int i = 0; i < W; ++i) {
            const Lane<V>& one = lane[i].row >= 0 ? lane[i] : other;
            start[i] = one.y;
            rate[i] = one.v;
            time[i] = one.t;
            alpha[i] = one.side[one.s].alpha;
            p2[i] = one.side[one.s].p2;
            side[i] = one.sign();
            for (int n = 0; n < set.sines; ++n) {
                angle[n][i] = reduced(fma(one.sines[n].omega, one.t, one.sines[n].phase), flip[n][i]);
                amplitude[n][i] = one.sines[n].amplitude * flip[n][i];
                omega[n][i] = one.sines[n].omega;
            }
            for (int m = 0; m < V; ++m)
                for (int k = 0; k < 2; ++k) tangent[m][k][i] = one.tangent[m][k];
        }
    }

    static Pack at(const double* numbers, int j) { return Pack::load(numbers + P * j); }

    void forcing() {
        const bool by_omega = V > 0 && set.parameter == Parameter::omega;
        for (int k = 0; k < kTerms; ++k) ROCKING_LANES u[k][j] = by[k][j] = Pack(0.0);
        for (int n = 0; n < set.sines; ++n) {
            Row sine, cosine, term, before;
            ROCKING_LANES {
                sine_cosine(at(angle[n], j), sine[j], cosine[j]);
                term[j] = at(amplitude[n], j);
                before[j] = Pack(0.0);
            }
            for (int k = 0; k < kTerms; ++k) {
                ROCKING_LANES {
                    const Pack now = k & 1 ? cosine[j] : sine[j];
                    u[k][j] = k & 2 ? fnma(term[j], now, u[k][j]) : fma(term[j], now, u[k][j]);
                    if (by_omega) {  // (t + tau) times the derivative by the phase
                        const Pack next = k & 1 ? sine[j] : cosine[j], signed_term = (k + 1) & 2 ? Pack(0.0) - term[j] : term[j];
                        by[k][j] = fma(at(time, j), signed_term * next, by[k][j]) + before[j];
                        before[j] = signed_term * next;
                    }
                    term[j] = term[j] * at(omega[n], j) * Pack(1.0 / (k + 1));
                }
            }
        }
    }

    // Sum over j = first ... k of a_j b_(k-j), as two partial sums.
    static void product(const Row* a, const Row* b, int k, int first, Row& sum) {
        Row odd;
        ROCKING_LANES sum[j] = odd[j] = Pack(0.0);
        int n = first;
        for (; n < k; n += 2) ROCKING_LANES {
                sum[j] = fma(a[n][j], b[k - n][j], sum[j]);
                odd[j] = fma(a[n + 1][j], b[k - n - 1][j], odd[j]);
            }
        ROCKING_LANES sum[j] = (n == k ? fma(a[n][j], b[0][j], sum[j]) : sum[j]) + odd[j];
    }

    void series() {
        forcing();
        ROCKING_LANES {
            c[0][j] = at(start, j);
            c[1][j] = at(rate, j);
            sine_cosine(at(alpha, j) - at(start, j), S[0][j], C[0][j]);
        }
        for (int k = 0; k + 2 < kTerms; ++k) {
            Row sum;
            if (set.linear) {
                ROCKING_LANES S[k][j] = (k ? Pack(0.0) : at(alpha, j)) - c[k][j], C[k][j] = Pack(k ? 0.0 : 1.0), F[k][j] = u[k][j];
            } else {
                if (k) {  // S' = C w', C' = -S w', w = alpha - y
                    const Pack over(1.0 / k);
                    ROCKING_LANES w[k][j] = c[k][j] * Pack(-1.0 * k);
                    product(w, C, k, 1, sum);
                    Row other;
                    product(w, S, k, 1, other);
                    ROCKING_LANES S[k][j] = sum[j] * over, C[k][j] = Pack(0.0) - other[j] * over;
                }
                product(u, C, k, 0, F[k]);
            }
            const Pack over(-1.0 / ((k + 1) * (k + 2)));
            ROCKING_LANES c[k + 2][j] = at(p2, j) * over * fma(at(side, j), F[k][j], S[k][j]);
        }
        for (int i = 0; i < W; ++i)  // the acceleration is zero at the time of uplift
            if (lane[i].lifts) reinterpret_cast<double*>(c[2])[i] = 0.0;
        if constexpr (V > 0) variations();
    }

    // Tangent vectors: d'' = G d, G = p^2 (C - s u S), and for a parameter the derivative of y'' at constant y.
    void variations() {
        const Parameter parameter = set.parameter;
        for (int k = 0; k + 2 < kTerms; ++k) {
            Row sum;
            if (!set.linear) product(u, S, k, 0, sum);
            ROCKING_LANES G[k][j] = set.linear ? (k ? Pack(0.0) : at(p2, j)) : at(p2, j) * fnma(at(side, j), sum[j], C[k][j]);
        }
        for (int m = 0; m < V; ++m) {
            ROCKING_LANES d[m][0][j] = at(tangent[m][0], j), d[m][1][j] = at(tangent[m][1], j);
            const bool forced = m == V - 1 && parameter != Parameter::none && parameter != Parameter::restitution;
            for (int k = 0; k + 2 < kTerms; ++k) {
                Row sum, more;
                product(G, d[m], k, 0, sum);
                if (forced && parameter == Parameter::omega) product(by, C, k, 0, more);
                const Pack over(1.0 / ((k + 1) * (k + 2)));
                ROCKING_LANES {
                    if (forced) {
                        if (parameter == Parameter::alpha) sum[j] = sum[j] - G[k][j];
                        else sum[j] = fnma(at(p2, j) * at(side, j), parameter == Parameter::omega ? more[j] : F[k][j], sum[j]);
                    }
                    d[m][k + 2][j] = sum[j] * over;
                }
            }
        }
    }

    // Approximate n-th root (error of a few per cent), computed only by operations with defined rounding.
    static double root(double x, int n) {
        int exponent;
        const double mantissa = std::frexp(x, &exponent), power = (exponent - 2.0 + 2.0 * mantissa) / n, below = std::floor(power);
        return std::ldexp(1.0 + (power - below), static_cast<int>(below));
    }
    void lengths() {
        alignas(64) double size[2][W];
        for (int k = 0; k < 2; ++k) ROCKING_LANES {
                Pack most = abs(c[kOrder - k][j]);
                for (int m = 0; m < V; ++m) {
                    const Pack norm = abs(d[m][0][j]) + abs(d[m][1][j]), relative = abs(d[m][kOrder - k][j]) * at(alpha, j) / norm;
                    most = select(norm > Pack(0.0), max(most, relative), most);
                }
                (most / at(alpha, j)).store(size[k] + P * j);
            }
        for (int i = 0; i < W; ++i) {
            h[i] = lane[i].row >= 0 ? lane[i].until - lane[i].t : 0.0;
            for (int k = 0; k < 2; ++k)
                if (size[k][i] > 0.0) h[i] = std::min(h[i], root(set.step_error / size[k][i], kOrder - k));
        }
    }

    // Rotation, velocity and tangent vectors at the ends of the steps, and bounds that exclude an earlier zero of y.
    void advance() {
        ROCKING_LANES {
            const Pack x = at(h, j);
            Pack value = c[kOrder][j], slope(0.0), bend = Pack(kOrder * (kOrder - 1.0)) * abs(value);
            for (int k = kOrder - 1; k >= 0; --k) {
                slope = fma(slope, x, value);
                value = fma(value, x, c[k][j]);
                bend = fma(bend, x, Pack(k * (k - 1.0)) * abs(c[k][j]));
            }
            value.store(ends + P * j);
            slope.store(rates + P * j);
            bend.store(bends + P * j);
            for (int m = 0; m < V; ++m) {
                Pack vector = d[m][kOrder][j], velocity(0.0);
                for (int k = kOrder - 1; k >= 0; --k) {
                    velocity = fma(velocity, x, vector);
                    vector = fma(vector, x, d[m][k][j]);
                }
                vector.store(tangent[m][0] + P * j);
                velocity.store(tangent[m][1] + P * j);
            }
        }
    }

    Column column(const Row* terms, int i) const {
        Column one;
        double power = 1.0;
        for (int k = 0; k < kTerms; ++k, power *= h[i]) one.c[k] = reinterpret_cast<const double*>(terms[k])[i] * power;
        return one;
    }

    void finish(int i) {
        Lane<V>& one = lane[i];
        const bool plain = std::min(start[i], ends[i]) > bends[i] / 8.0;
        Event event = Event::none;
        ++one.steps;
        if (!(h[i] > 0.0) || !std::isfinite(ends[i])) {
            event = Event::failed;
        } else if (plain) {
            move(one, i);
            const bool turns = rate[i] > 0.0 ? one.v < 0.0 : V == 3 && one.v > 0.0;
            if (turns && driver.counts_peaks(one)) crest(one, column(c, i), 1.0);
        } else {
            event = with_zero(one, i);
        }
        one.lifts = false;
        if (event == Event::none && one.y > one.side[one.s].alpha && one.is_lost()) event = Event::overturned;
        one.peak = std::max(one.peak, one.y / one.side[one.s].alpha);
        if (event != Event::none && !driver.happened(one, event)) one.row = -1;
        ready(i);
    }
    void move(Lane<V>& one, int i) {
        one.t = h[i] < one.until - one.t ? one.t + h[i] : one.until;
        one.y = ends[i];
        one.v = rates[i];
        for (int m = 0; m < V; ++m)
            for (int k = 0; k < 2; ++k) one.tangent[m][k] = tangent[m][k][i];
    }
    Event with_zero(Lane<V>& one, int i) {
        const Column y = column(c, i);
        const int skip = one.y > 0.0 ? 0 : one.lifts ? 3 : one.v > 0.0 ? 1 : 2;
        if (!(y.c[skip] > 0.0)) return Event::failed;
        const bool lands_at_end = ends[i] <= 0.0 && rates[i] < 0.0;  // a zero at the end that rounding hides
        const double root = y.zero(skip), zero = lands_at_end ? std::min(root, 1.0) : root;
        if (driver.counts_peaks(one)) crest(one, y, zero);
        if (zero > 1.0) {
            move(one, i);
            return Event::none;
        }
        double value, half;
        y.derivatives(zero, value, one.v, half);
        one.v /= h[i];
        one.falling = 2.0 * half / (h[i] * h[i]);
        for (int m = 0; m < V; ++m) {
            column(d[m], i).derivatives(zero, one.tangent[m][0], one.tangent[m][1], half);
            one.tangent[m][1] /= h[i];
        }
        one.t += zero * h[i];
        return one.land();
    }
    // Records the highest and the lowest point within a step.
    void crest(Lane<V>& one, const Column& y, double end) {
        one.peak = std::max(one.peak, y.top(end) / one.side[one.s].alpha);
        if (V == 3) one.trough = std::min(one.trough, -y.top(end, -1.0) / one.side[one.s].alpha);
    }
};

}  // namespace rocking::ROCKING_ISA::longrun
