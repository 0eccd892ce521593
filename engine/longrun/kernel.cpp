// Histories over many periods, and motions between impacts, for one instruction set; compiled once for each set.
#include "kernel.hpp"

#include "lanes.hpp"

namespace rocking::ROCKING_ISA::longrun {

// Histories over complete periods of the first sine. With one sine, time starts from zero in each period.
template <int V>
class Periods {
    const double* start(const Lane<V>& lane) const { return work.starts + kStart * lane.row; }
    double period(const Lane<V>& lane) const { return 2.0 * kPi / lane.sines[0].omega; }

    void next_period(Lane<V>& lane) const {
        if (lane.cycle == work.settled) {
            lane.peak = lane.y / lane.side[lane.s].alpha;
            lane.growth[0] = lane.growth[1] = 0.0;
            lane.earlier_impacts = lane.impacts;
            lane.earlier_rests = lane.rests;
        }
        if (work.set.sines == 1) lane.t = start(lane)[0];
        lane.until = start(lane)[0] + period(lane) * static_cast<double>(work.set.sines == 1 ? 1 : lane.cycle + 1);
    }

    void grow(Lane<V>& lane) const {
        const double p = std::sqrt(lane.side[lane.s].p2);
        for (int m = 0; m < V; ++m) {
            double* vector = lane.tangent[m];
            if (m == 1) {  // makes the second vector orthogonal to the first vector
                const double along = fma(vector[0], lane.tangent[0][0], vector[1] * lane.tangent[0][1] / (p * p));
                for (int k = 0; k < 2; ++k) vector[k] = fma(-along, lane.tangent[0][k], vector[k]);
            }
            const double norm = std::sqrt(fma(vector[0], vector[0], vector[1] * vector[1] / (p * p)));
            lane.growth[m] += std::log(norm);
            // a body at rest: the difference between neighbouring orbits is zero, and a unit vector replaces it
            vector[0] = norm > 0.0 ? vector[0] / norm : 1.0 - m;
            vector[1] = norm > 0.0 ? vector[1] / norm : m * p;
        }
    }

    void write(const Lane<V>& lane, Event end) const {
        double* result = work.results + kResults * lane.row;
        const double values[kResults] = {static_cast<double>(end), static_cast<double>(lane.cycle), static_cast<double>(lane.impacts - lane.earlier_impacts),
                                         static_cast<double>(lane.rests - lane.earlier_rests), lane.peak, lane.growth[0], lane.growth[1],
                                         static_cast<double>(lane.stored), static_cast<double>(lane.steps)};
        std::copy(values, values + kResults, result);
    }

  public:
    const Cycles& work;
    bool counts_peaks(const Lane<V>& lane) const { return lane.cycle >= work.settled; }

    void begin(Lane<V>& lane) const {
        const double* from = start(lane);
        lane.s = from[1] < 0.0 || (from[1] == 0.0 && from[2] < 0.0);
        lane.y = std::fabs(from[1]);
        lane.v = lane.s ? -from[2] : from[2];
        for (int m = 0; m < V; ++m) {
            lane.tangent[m][0] = 1.0 - m;
            lane.tangent[m][1] = std::sqrt(lane.side[0].p2) * (m == 0 ? 0.6 : 1.0);
        }
        if (lane.y == 0.0 && lane.v == 0.0) lane.settle();
        next_period(lane);
    }
    // Ends a period.
    bool arrived(Lane<V>& lane) const {
        if (lane.cycle >= work.settled) {
            double* section = work.sections + 2 * (work.kept * lane.row + lane.cycle - work.settled);
            section[0] = lane.sign() * lane.y;
            section[1] = lane.sign() * lane.v;
        }
        grow(lane);
        ++lane.cycle;
        if (lane.cycle == work.settled + work.kept) {
            write(lane, Event::none);
            return false;
        }
        next_period(lane);
        return true;
    }
    bool happened(Lane<V>& lane, Event event) const {
        if (event == Event::overturned || event == Event::failed) {
            write(lane, event);
            return false;
        }
        if (event == Event::impact && lane.cycle >= work.settled && lane.stored < work.most_impacts) {
            double* impact = work.impacts + 3 * (work.most_impacts * lane.row + lane.stored++);
            impact[0] = work.set.sines == 1 ? fma(static_cast<double>(lane.cycle), period(lane), lane.t) : lane.t;
            impact[1] = lane.sign() * lane.v;
            impact[2] = lane.before;
        }
        return true;
    }
};

// Motions over a number of impacts. Three tangent vectors: derivatives by start time, start speed and a parameter.
template <int V>
class Impacts {
    static constexpr std::int64_t kMostSteps = 10000;  // largest number of steps between two impacts

    void write(const Lane<V>& lane, Event event) const {
        double* end = work.ends + kEnds * lane.row;
        end[0] = lane.t;
        end[1] = lane.v;
        end[2] = lane.sign();
        end[3] = static_cast<double>(event);
        const double after = lane.acceleration();
        for (int m = 0; m < V; ++m) {
            const double time = -lane.tangent[m][0] / lane.v;
            end[4 + m] = time;
            end[7 + m] = fma(after, time, lane.tangent[m][1]);
        }
        end[10] = lane.peak;
        end[11] = lane.before;
        end[12] = lane.trough;
    }

  public:
    const Flights& work;
    bool counts_peaks(const Lane<V>&) const { return true; }
    void begin(Lane<V>& lane) const {
        const double* start = work.starts + kStart * lane.row;
        lane.v = start[1];
        lane.s = start[2] < 0.0;
        lane.until = 1e300;
        if constexpr (V == 3) {
            lane.tangent[0][0] = -lane.v;
            lane.tangent[0][1] = -lane.acceleration();
            lane.tangent[1][1] = 1.0;
        }
    }
    bool arrived(Lane<V>& lane) const {
        write(lane, Event::failed);
        return false;
    }
    bool happened(Lane<V>& lane, Event event) const {
        if (event == Event::impact && lane.steps > kMostSteps * lane.impacts) event = Event::failed;
        if (event == Event::impact && lane.impacts < work.impacts) return true;
        write(lane, event);
        return false;
    }
};

void run(const Cycles& work, int vectors, Queue& queue) {
    if (vectors == 0) Lanes<0, Periods<0>>({work}, queue).run();
    if (vectors == 1) Lanes<1, Periods<1>>({work}, queue).run();
    if (vectors == 2) Lanes<2, Periods<2>>({work}, queue).run();
}

void run(const Flights& work, int vectors, Queue& queue) {
    if (vectors == 0) Lanes<0, Impacts<0>>({work}, queue).run();
    if (vectors == 3) Lanes<3, Impacts<3>>({work}, queue).run();
}

}  // namespace rocking::ROCKING_ISA::longrun
