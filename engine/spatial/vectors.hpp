// Vectors in 3D: three numbers for events, and four numbers in one register for the steps.
#pragma once
#include <cmath>

#if defined(__clang__)
#define ROCKING_EACH_TERM _Pragma("clang loop unroll(full)")
#elif defined(__GNUC__)
#define ROCKING_EACH_TERM _Pragma("GCC unroll 24")
#else
#define ROCKING_EACH_TERM
#endif

namespace rocking::spatial {
namespace ROCKING_ISA {

inline double lesser(double a, double b) { return a < b ? a : b; }
inline double greater(double a, double b) { return a > b ? a : b; }

struct Vec {
    double x = 0.0, y = 0.0, z = 0.0;
};
inline Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec operator*(double s, Vec a) { return {s * a.x, s * a.y, s * a.z}; }
inline double dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec cross(Vec a, Vec b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline double norm(Vec a) { return std::sqrt(dot(a, a)); }
inline double largest(Vec a) { return greater(std::fabs(a.x), greater(std::fabs(a.y), std::fabs(a.z))); }
inline bool finite(Vec a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }

struct Mat {  // rows
    Vec a, b, c;
};
inline Vec operator*(const Mat& m, Vec v) { return {dot(m.a, v), dot(m.b, v), dot(m.c, v)}; }
inline Mat operator*(double s, const Mat& m) { return {s * m.a, s * m.b, s * m.c}; }
inline Mat operator+(const Mat& m, const Mat& n) { return {m.a + n.a, m.b + n.b, m.c + n.c}; }
inline Mat operator-(const Mat& m, const Mat& n) { return {m.a - n.a, m.b - n.b, m.c - n.c}; }
inline Vec row_times(Vec v, const Mat& m) { return v.x * m.a + v.y * m.b + v.z * m.c; }
inline Mat outer(Vec a, Vec b) { return {a.x * b, a.y * b, a.z * b}; }
inline Mat diagonal(double s) { return {{s, 0.0, 0.0}, {0.0, s, 0.0}, {0.0, 0.0, s}}; }
inline Mat inverse(const Mat& m) {
    const Vec p = cross(m.b, m.c), q = cross(m.c, m.a), r = cross(m.a, m.b);
    const double s = 1.0 / dot(m.a, p);
    return s * Mat{{p.x, q.x, r.x}, {p.y, q.y, r.y}, {p.z, q.z, r.z}};
}

#if defined(__GNUC__) || defined(__clang__)
typedef double Four __attribute__((vector_size(32)));
template <int i, int j, int k, int l>
inline Four mixed(Four a) {
#if defined(__clang__) || __GNUC__ >= 12
    return __builtin_shufflevector(a, a, i, j, k, l);
#else
    typedef long long Places __attribute__((vector_size(32)));
    return __builtin_shuffle(a, Places{i, j, k, l});
#endif
}
inline Four four(double s) { return Four{s, s, s, s}; }
inline Four lesser(Four a, Four b) { return a < b ? a : b; }
inline Four greater(Four a, Four b) { return a > b ? a : b; }
#else
struct Four {
    double v[4];
    double operator[](int i) const { return v[i]; }
};
#define ROCKING_FOUR(op) \
    inline Four operator op(Four a, Four b) { return {{a.v[0] op b.v[0], a.v[1] op b.v[1], a.v[2] op b.v[2], a.v[3] op b.v[3]}}; }
ROCKING_FOUR(+)
ROCKING_FOUR(-)
ROCKING_FOUR(*)
#undef ROCKING_FOUR
template <int i, int j, int k, int l>
inline Four mixed(Four a) {
    return {{a.v[i], a.v[j], a.v[k], a.v[l]}};
}
inline Four four(double s) { return {{s, s, s, s}}; }
inline Four lesser(Four a, Four b) {
    for (int i = 0; i < 4; ++i) a.v[i] = a.v[i] < b.v[i] ? a.v[i] : b.v[i];
    return a;
}
inline Four greater(Four a, Four b) {
    for (int i = 0; i < 4; ++i) a.v[i] = a.v[i] > b.v[i] ? a.v[i] : b.v[i];
    return a;
}
#endif

template <int i>
inline Four all_of(Four a) {
    return mixed<i, i, i, i>(a);
}
inline Four next_of(Four a) { return mixed<1, 2, 0, 3>(a); }  // y, z, x
inline Four packed(Vec a) { return Four{a.x, a.y, a.z, 0.0}; }
inline Vec vec(Four a) { return {a[0], a[1], a[2]}; }

}  // namespace ROCKING_ISA
}  // namespace rocking::spatial
