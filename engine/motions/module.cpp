// Fast versions of expensive operations of synthetic motions: elementary functions and recurrences of sums and
// products, in the order of `portable.py`. Thus a seed gives the same bits on all processors, with and without this
// module. The module also contains response spectra, which are measures without this requirement.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/complex.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <vector>

#include "oscillators.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace rocking::motions {

template <class T>
using Line = nb::ndarray<T, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

constexpr double kLog2High = 6.93147180369123816490e-01, kLog2Low = 1.90821492927058770002e-10;
constexpr double kHalfPiHigh = 1.57079632673412561417e+00, kHalfPiLow = 6.07710050650619224932e-11;
constexpr double kRound = 6755399441055744.0;  // 1.5 * 2^52: adding and subtracting this number rounds to an integer

// Terms of the series, divided in the same way as in Python.
struct Factorials {
    double inverse[19] = {1.0};
    constexpr Factorials() {
        double factorial = 1.0;
        for (int k = 1; k < 19; ++k) inverse[k] = 1.0 / (factorial *= k);
    }
};
constexpr Factorials kTerms;

static inline double from_bits(std::uint64_t bits) {
    double value;
    std::memcpy(&value, &bits, sizeof value);
    return value;
}

static inline std::uint64_t bits_of(double value) {
    std::uint64_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    return bits;
}

static inline double exponential(double x) {
    const double inside = std::min(std::max(x, -708.0), 709.0), rounded = inside * 1.44269504088896338700e+00 + kRound;
    const double k = rounded - kRound;
    const double r = (inside - k * kLog2High) - k * kLog2Low;
    double p = kTerms.inverse[13];
    for (int n = 12; n >= 0; --n) p = p * r + kTerms.inverse[n];
    // the last bits of the rounded value are k; they become the exponent of a power of two
    const double power = from_bits((bits_of(rounded) + 1023) << 52);
    return x < -708.0 ? 0.0 : p * power;
}

static inline double logarithm(double x) {
    // x = m 2^e with m from sqrt(1/2) to sqrt(2)
    constexpr std::uint64_t kRootHalf = 0x3fe6a09e667f3bcd, kTwo52 = 0x4330000000000000;
    const std::uint64_t biased = (bits_of(x) - kRootHalf + (std::uint64_t{1023} << 52)) >> 52;
    const double e = from_bits(biased | kTwo52) - 4503599627371519.0;
    const double m = from_bits(bits_of(x) - ((biased - 1023) << 52));
    const double s = (m - 1.0) / (m + 1.0), z = s * s;
    double p = 2.0 / 23.0;
    for (int n = 21; n > 0; n -= 2) p = p * z + 2.0 / n;
    const double logarithm = e * kLog2High + (s * p + e * kLog2Low);
    return x >= std::numeric_limits<double>::min() ? logarithm : -std::numeric_limits<double>::infinity();
}

static inline void cosine_sine(double x, double& cosine, double& sine) {
    const double k = (x * 6.36619772367581382433e-01 + kRound) - kRound;
    const double r = (x - k * kHalfPiHigh) - k * kHalfPiLow, z = r * r;
    double c = kTerms.inverse[18], s = kTerms.inverse[17];
    for (int n = 16; n >= 0; n -= 2) c = kTerms.inverse[n] - c * z;
    for (int n = 15; n > 0; n -= 2) s = kTerms.inverse[n] - s * z;
    s = s * r;
    const int quarter = static_cast<int>(static_cast<std::int64_t>(k) & 3);
    cosine = quarter == 0 ? c : quarter == 1 ? -s : quarter == 2 ? -c : s;
    sine = quarter == 0 ? s : quarter == 1 ? c : quarter == 2 ? -s : -c;
}

static void check(bool fits) {
    if (!fits) throw std::invalid_argument("arrays of one length expected");
}

ROCKING_WIDER void exponentials_of(const double* from, double* to, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) to[i] = exponential(from[i]);
}

static void exponentials(Line<const double> x, Line<double> out) {
    check(x.shape(0) == out.shape(0));
    exponentials_of(x.data(), out.data(), x.shape(0));
}

ROCKING_WIDER void logarithms_of(const double* from, double* to, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) to[i] = logarithm(from[i]);
}

static void logarithms(Line<const double> x, Line<double> out) {
    check(x.shape(0) == out.shape(0));
    logarithms_of(x.data(), out.data(), x.shape(0));
}

static void cosines_sines(Line<const double> x, Line<double> cosine, Line<double> sine) {
    check(x.shape(0) == cosine.shape(0) && x.shape(0) == sine.shape(0));
    for (std::size_t i = 0; i < x.shape(0); ++i) cosine_sine(x.data()[i], cosine.data()[i], sine.data()[i]);
}

// Advances two states by a matrix and by their increments in every step.
static void recurrence(double m00, double m01, double m10, double m11, Line<const double> first, Line<const double> second,
                       Line<double> z, Line<double> v) {
    check(first.shape(0) == second.shape(0) && z.shape(0) == first.shape(0) + 1 && v.shape(0) == z.shape(0));
    double a = z.data()[0], b = v.data()[0];
    for (std::size_t i = 0; i < first.shape(0); ++i) {
        const double before = a;
        a = (m00 * before + m01 * b) + first.data()[i];
        b = (m10 * before + m11 * b) + second.data()[i];
        z.data()[i + 1] = a;
        v.data()[i + 1] = b;
    }
}

// Four oscillators in parallel: rotation per step, rotation by twice this angle, and states.
constexpr int kLanes = 4, kNeighbours = 10;
struct Four {
    double c[kLanes] = {}, s[kLanes] = {}, q[kLanes] = {}, cc[kLanes] = {}, ss[kLanes] = {};
    double u[kLanes] = {}, v[kLanes] = {}, e[kLanes] = {}, f[kLanes] = {}, g[kLanes] = {};
};

ROCKING_WIDER void turn(Four* from, const Four* end, Four* fed, int feeds, const double* weight, double kick, double gain, double* sums,
          double* squares) {
    for (int k = 0; k < feeds; ++k)
        for (int i = 0; i < kLanes; ++i) {
            const double share = weight[kLanes * k + i], more = gain * share;
            fed[k].u[i] += kick * share;
            fed[k].e[i] += more;
            fed[k].f[i] += more;
        }
    double sum[kLanes] = {}, square[kLanes] = {};
    for (; from != end; ++from) {
        Four& a = *from;
        for (int i = 0; i < kLanes; ++i) {
            const double x = a.u[i], y = a.v[i], p = a.f[i], r = a.g[i];
            const double v = a.s[i] * x + a.c[i] * y, f = a.cc[i] * p - a.ss[i] * r, e = a.q[i] * a.e[i];
            a.u[i] = a.c[i] * x - a.s[i] * y;
            a.v[i] = v;
            a.e[i] = e;
            a.f[i] = f;
            a.g[i] = a.ss[i] * p + a.cc[i] * r;
            sum[i] += v;
            square[i] += e - f;
        }
    }
    for (int i = 0; i < kLanes; ++i) {
        sums[i] = sum[i];
        squares[i] = square[i];
    }
}

// Lagrange weights of `width` neighbours at integer positions, for a position from 0 to 1 in their middle.
template <int width>
struct Shares {
    double scale[width];
    Shares() {
        for (int i = 0; i < width; ++i) {
            scale[i] = 1.0;
            for (int k = 0; k < width; ++k)
                if (k != i) scale[i] *= i - k;
            scale[i] = 1.0 / scale[i];
        }
    }
    void at(double position, double* weight) const {
        const double x = position + (width - 1) / 2;
        double before = 1.0, after = 1.0;
        for (int i = 0; i < width; ++i) {
            weight[i] = before;
            before *= x - i;
        }
        for (int i = width - 1; i >= 0; --i) {
            weight[i] = (weight[i] * after) * scale[i];
            after *= x - i;
        }
    }
};

// Impulses on damped oscillators with fixed frequencies, in order. An impulse is distributed to the neighbours of its
// position. Outputs after every step: sums of the sines, and twice the sums of the squared responses.
template <int width>
static void resonate(const double* noise, const double* omega, const double* positions, std::int64_t count, std::vector<Four>& four,
                     const std::int64_t* lasting, std::int64_t nodes, double* total, double* variance) {
    std::vector<std::int64_t> fed(four.size() * kLanes, 0);
    const Shares<width> shares;
    std::int64_t low = 0, past = 0;
    // compute the weights of several steps first: a vector load soon after single stores is slow
    constexpr int kStretch = 32, kRoom = (width / kLanes + 2) * kLanes;
    double weights[kStretch][kRoom];
    for (std::int64_t n = 0; n < count; ++n) {
        const std::int64_t step = n % kStretch;
        if (step == 0) {
            std::memset(weights, 0, sizeof weights);
            for (std::int64_t k = n; k < std::min(count, n + kStretch); ++k) {
                const auto base = static_cast<std::int64_t>(positions[k]);
                check(base >= 0 && base + width <= nodes);
                shares.at(positions[k] - static_cast<double>(base), weights[k - n] + base % kLanes);
            }
        }
        const auto base = static_cast<std::int64_t>(positions[n]), first = base / kLanes, last = (base + width - 1) / kLanes;
        check(base >= past);
        for (; past < base; ++past) fed[past] = n - 1;
        while (low < base && n - fed[low] > lasting[low]) ++low;
        const double w = omega[n];
        double sums[kLanes], squares[kLanes];
        turn(four.data() + low / kLanes, four.data() + last + 1, four.data() + first, static_cast<int>(last - first) + 1,
             weights[step], noise[n] * w, w * w, sums, squares);
        total[n + 1] = (sums[0] + sums[1]) + (sums[2] + sums[3]);
        variance[n + 1] = (squares[0] + squares[1]) + (squares[2] + squares[3]);
    }
}

static void resonances(Line<const double> noise, Line<const double> omega, Line<const double> positions, bool shared,
                       Line<const double> cosine, Line<const double> sine, Line<const std::int64_t> lasting, Line<double> total,
                       Line<double> variance) {
    const std::size_t count = positions.shape(0), nodes = cosine.shape(0);
    check(noise.shape(0) >= count && omega.shape(0) >= count && sine.shape(0) == nodes && lasting.shape(0) == nodes &&
          total.shape(0) == count + 1 && variance.shape(0) == count + 1);
    std::vector<Four> four((nodes + kLanes - 1) / kLanes);
    for (std::size_t j = 0; j < nodes; ++j) {
        Four& a = four[j / kLanes];
        const double x = cosine.data()[j], y = sine.data()[j];
        const std::size_t lane = j % kLanes;
        a.c[lane] = x;
        a.s[lane] = y;
        a.q[lane] = x * x + y * y;
        a.cc[lane] = x * x - y * y;
        a.ss[lane] = 2.0 * (x * y);
    }
    const auto run = shared ? resonate<kNeighbours> : resonate<1>;
    run(noise.data(), omega.data(), positions.data(), static_cast<std::int64_t>(count), four, lasting.data(),
        static_cast<std::int64_t>(nodes), total.data(), variance.data());
}

static void states(Line<const double> ground, double step, Line<const Complex> rates,
                   nb::ndarray<Complex, nb::ndim<2>, nb::c_contig, nb::device::cpu> out) {
    check(out.shape(0) == rates.shape(0) && out.shape(1) == ground.shape(0) && ground.shape(0) > 0);
    nb::gil_scoped_release free;
    states_of(ground.data(), ground.shape(0), step, rates.data(), rates.shape(0), out.data());
}

static void peaks(Line<const double> ground, double step, Line<const Complex> rates,
                  nb::ndarray<const double, nb::ndim<2>, nb::c_contig, nb::device::cpu> reach, Line<const std::int64_t> parts,
                  double margin, std::int64_t points, nb::ndarray<double, nb::ndim<2>, nb::c_contig, nb::device::cpu> out) {
    const std::size_t count = rates.shape(0);
    check(reach.shape(0) == count && reach.shape(1) == 3 && parts.shape(0) == count && out.shape(0) == count &&
          out.shape(1) == 3 && ground.shape(0) > 0 && points > 1);
    nb::gil_scoped_release free;
    peaks_of(ground.data(), ground.shape(0), step, rates.data(), count, reach.data(), parts.data(), margin, points, out.data());
}

static void directions(Line<const double> along, Line<const double> across, double step, Line<const Complex> rates,
                       Line<const double> cosine, Line<const double> sine, Line<const std::int64_t> parts, std::int64_t points,
                       nb::ndarray<double, nb::ndim<2>, nb::c_contig, nb::device::cpu> out) {
    const std::size_t count = rates.shape(0), turns = cosine.shape(0);
    check(along.shape(0) == across.shape(0) && along.shape(0) > 0 && sine.shape(0) == turns && turns > 0 &&
          parts.shape(0) == count && out.shape(0) == count && out.shape(1) == turns && points > 1);
    nb::gil_scoped_release free;
    directions_of(along.data(), across.data(), along.shape(0), step, rates.data(), count, cosine.data(), sine.data(), turns,
                  parts.data(), points, out.data());
}

}  // namespace rocking::motions

NB_MODULE(_filters, m) {
    using namespace rocking::motions;
    m.doc() = "Elementary functions and recurrences of synthetic motions.";
    m.def("exponentials", &exponentials, "x"_a, "out"_a);
    m.def("logarithms", &logarithms, "x"_a, "out"_a);
    m.def("cosines_sines", &cosines_sines, "x"_a, "cosine"_a, "sine"_a);
    m.def("recurrence", &recurrence, "m00"_a, "m01"_a, "m10"_a, "m11"_a, "first"_a, "second"_a, "z"_a, "v"_a);
    m.def("resonances", &resonances, "noise"_a, "omega"_a, "place"_a, "shared"_a, "cosine"_a, "sine"_a, "lasting"_a, "total"_a,
          "variance"_a);
    m.def("states", &states, "ground"_a, "step"_a, "rates"_a, "out"_a);
    m.def("peaks", &peaks, "ground"_a, "step"_a, "rates"_a, "reach"_a, "parts"_a, "margin"_a, "points"_a, "out"_a);
    m.def("directions", &directions, "along"_a, "across"_a, "step"_a, "rates"_a, "cosine"_a, "sine"_a, "parts"_a, "points"_a,
          "out"_a);
}
