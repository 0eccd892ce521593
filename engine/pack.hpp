// A small number of doubles with common operations: one AVX-512 or AVX2 register, or four plain numbers.
// Every operation is the same on every lane. Fused multiply-adds are explicit, and the compiler adds none. Therefore
// a history has the same bits in every lane.
#pragma once
#include <cmath>
#include <cstdint>

#if defined(ROCKING_AVX512) || defined(ROCKING_AVX2)
#include <immintrin.h>
#endif

#if defined(__clang__)
#define ROCKING_UNROLL _Pragma("clang loop unroll(full)")
#define ROCKING_ROLLED _Pragma("clang loop unroll(disable)")
#define ROCKING_INLINE inline __attribute__((always_inline))
#define ROCKING_APART __attribute__((noinline))
#elif defined(__GNUC__)
#define ROCKING_UNROLL _Pragma("GCC unroll 16")
#define ROCKING_ROLLED _Pragma("GCC unroll 1")
#define ROCKING_INLINE inline __attribute__((always_inline))
#define ROCKING_APART __attribute__((noinline))
#elif defined(_MSC_VER)
#define ROCKING_UNROLL
#define ROCKING_ROLLED
#define ROCKING_INLINE __forceinline
#define ROCKING_APART __declspec(noinline)
#else
#define ROCKING_UNROLL
#define ROCKING_ROLLED
#define ROCKING_INLINE inline
#define ROCKING_APART
#endif

#if defined(__GNUC__) || defined(__clang__)
#define ROCKING_PREFETCH(place) __builtin_prefetch(place)
#else
#define ROCKING_PREFETCH(place) static_cast<void>(place)
#endif

namespace rocking {
namespace ROCKING_ISA {

#if defined(ROCKING_PACK)
#include ROCKING_PACK  // numbers that also count their operations: see benchmarks/counted_pack.hpp
#elif defined(ROCKING_AVX512)

struct Mask {
    __mmask8 m;
    unsigned bits() const { return m; }
};
inline Mask operator|(Mask a, Mask b) { return {static_cast<__mmask8>(a.m | b.m)}; }
inline Mask operator&(Mask a, Mask b) { return {static_cast<__mmask8>(a.m & b.m)}; }
inline Mask operator!(Mask a) { return {static_cast<__mmask8>(~a.m)}; }

struct Pack {
    static constexpr int width = 8;
    __m512d r;
    Pack() = default;
    Pack(__m512d v) : r(v) {}
    Pack(double v) : r(_mm512_set1_pd(v)) {}
    static Pack load(const double* p) { return _mm512_load_pd(p); }
    static Pack load_any(const double* p) { return _mm512_loadu_pd(p); }
    void store(double* p) const { _mm512_store_pd(p, r); }
    void store_where(Mask where, double* p) const { _mm512_mask_store_pd(p, where.m, r); }
    static Pack gather(const double* base, const std::int64_t* k) {
        return _mm512_i64gather_pd(_mm512_load_si512(k), base, 8);
    }
    // Loads numbers and their neighbours in memory: fewer loads than two gathers.
    static void pairs(const double* base, const std::int64_t* k, Pack& first, Pack& second) {
        const auto two = [&](int i) {
            return _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_loadu_pd(base + k[i])), _mm_loadu_pd(base + k[i + 2]), 1);
        };
        const auto four = [&](int i) { return _mm512_insertf64x4(_mm512_castpd256_pd512(two(i)), two(i + 4), 1); };
        const __m512d even = four(0), odd = four(1);
        first = _mm512_unpacklo_pd(even, odd);
        second = _mm512_unpackhi_pd(even, odd);
    }
};
inline Pack operator+(Pack a, Pack b) { return _mm512_add_pd(a.r, b.r); }
inline Pack operator-(Pack a, Pack b) { return _mm512_sub_pd(a.r, b.r); }
inline Pack operator*(Pack a, Pack b) { return _mm512_mul_pd(a.r, b.r); }
inline Pack operator/(Pack a, Pack b) { return _mm512_div_pd(a.r, b.r); }
inline Pack fma(Pack a, Pack b, Pack c) { return _mm512_fmadd_pd(a.r, b.r, c.r); }
inline Pack fnma(Pack a, Pack b, Pack c) { return _mm512_fnmadd_pd(a.r, b.r, c.r); }
inline Pack abs(Pack a) { return _mm512_abs_pd(a.r); }
inline Pack sqrt(Pack a) { return _mm512_sqrt_pd(a.r); }
inline Pack min(Pack a, Pack b) { return _mm512_min_pd(a.r, b.r); }
inline Pack max(Pack a, Pack b) { return _mm512_max_pd(a.r, b.r); }
inline Mask operator<(Pack a, Pack b) { return {_mm512_cmp_pd_mask(a.r, b.r, _CMP_LT_OQ)}; }
inline Mask operator>(Pack a, Pack b) { return {_mm512_cmp_pd_mask(a.r, b.r, _CMP_GT_OQ)}; }
inline Mask operator>=(Pack a, Pack b) { return {_mm512_cmp_pd_mask(a.r, b.r, _CMP_GE_OQ)}; }
inline Mask operator==(Pack a, Pack b) { return {_mm512_cmp_pd_mask(a.r, b.r, _CMP_EQ_OQ)}; }
inline Pack select(Mask m, Pack yes, Pack no) { return _mm512_mask_blend_pd(m.m, no.r, yes.r); }
#define ROCKING_SCALAR_FMA(a, b, c) __builtin_fma(a, b, c)

struct Whole {
    __m512i r;
    static Whole load(const std::int64_t* p) { return {_mm512_load_si512(p)}; }
    void store(std::int64_t* p) const { _mm512_store_si512(p, r); }
    Whole plus(std::int64_t n, Mask where) const { return {_mm512_mask_add_epi64(r, where.m, r, _mm512_set1_epi64(n))}; }
};
inline Mask operator>=(Whole a, Whole b) { return {_mm512_cmpge_epi64_mask(a.r, b.r)}; }
inline Whole select(Mask m, Whole yes, Whole no) { return {_mm512_mask_blend_epi64(m.m, no.r, yes.r)}; }

#elif defined(ROCKING_AVX2)

struct Mask {
    __m256d m;
    unsigned bits() const { return static_cast<unsigned>(_mm256_movemask_pd(m)); }
};
inline Mask operator|(Mask a, Mask b) { return {_mm256_or_pd(a.m, b.m)}; }
inline Mask operator&(Mask a, Mask b) { return {_mm256_and_pd(a.m, b.m)}; }
inline Mask operator!(Mask a) { return {_mm256_xor_pd(a.m, _mm256_castsi256_pd(_mm256_set1_epi64x(-1)))}; }

struct Pack {
    static constexpr int width = 4;
    __m256d r;
    Pack() = default;
    Pack(__m256d v) : r(v) {}
    Pack(double v) : r(_mm256_set1_pd(v)) {}
    static Pack load(const double* p) { return _mm256_load_pd(p); }
    static Pack load_any(const double* p) { return _mm256_loadu_pd(p); }
    void store(double* p) const { _mm256_store_pd(p, r); }
    void store_where(Mask where, double* p) const { _mm256_maskstore_pd(p, _mm256_castpd_si256(where.m), r); }
    static Pack gather(const double* base, const std::int64_t* k) {
        return _mm256_i64gather_pd(base, _mm256_load_si256(reinterpret_cast<const __m256i*>(k)), 8);
    }
    static void pairs(const double* base, const std::int64_t* k, Pack& first, Pack& second) {
        const auto two = [&](int i) {
            return _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_loadu_pd(base + k[i])), _mm_loadu_pd(base + k[i + 2]), 1);
        };
        const __m256d even = two(0), odd = two(1);
        first = _mm256_unpacklo_pd(even, odd);
        second = _mm256_unpackhi_pd(even, odd);
    }
};
inline Pack operator+(Pack a, Pack b) { return _mm256_add_pd(a.r, b.r); }
inline Pack operator-(Pack a, Pack b) { return _mm256_sub_pd(a.r, b.r); }
inline Pack operator*(Pack a, Pack b) { return _mm256_mul_pd(a.r, b.r); }
inline Pack operator/(Pack a, Pack b) { return _mm256_div_pd(a.r, b.r); }
inline Pack fma(Pack a, Pack b, Pack c) { return _mm256_fmadd_pd(a.r, b.r, c.r); }
inline Pack fnma(Pack a, Pack b, Pack c) { return _mm256_fnmadd_pd(a.r, b.r, c.r); }
inline Pack abs(Pack a) { return _mm256_andnot_pd(_mm256_set1_pd(-0.0), a.r); }
inline Pack sqrt(Pack a) { return _mm256_sqrt_pd(a.r); }
inline Pack min(Pack a, Pack b) { return _mm256_min_pd(a.r, b.r); }
inline Pack max(Pack a, Pack b) { return _mm256_max_pd(a.r, b.r); }
inline Mask operator<(Pack a, Pack b) { return {_mm256_cmp_pd(a.r, b.r, _CMP_LT_OQ)}; }
inline Mask operator>(Pack a, Pack b) { return {_mm256_cmp_pd(a.r, b.r, _CMP_GT_OQ)}; }
inline Mask operator>=(Pack a, Pack b) { return {_mm256_cmp_pd(a.r, b.r, _CMP_GE_OQ)}; }
inline Mask operator==(Pack a, Pack b) { return {_mm256_cmp_pd(a.r, b.r, _CMP_EQ_OQ)}; }
inline Pack select(Mask m, Pack yes, Pack no) { return _mm256_blendv_pd(no.r, yes.r, m.m); }
#define ROCKING_SCALAR_FMA(a, b, c) __builtin_fma(a, b, c)

struct Whole {
    __m256i r;
    static Whole load(const std::int64_t* p) { return {_mm256_load_si256(reinterpret_cast<const __m256i*>(p))}; }
    void store(std::int64_t* p) const { _mm256_store_si256(reinterpret_cast<__m256i*>(p), r); }
    Whole plus(std::int64_t n, Mask where) const {
        return {_mm256_add_epi64(r, _mm256_and_si256(_mm256_castpd_si256(where.m), _mm256_set1_epi64x(n)))};
    }
};
inline Mask operator>=(Whole a, Whole b) { return !Mask{_mm256_castsi256_pd(_mm256_cmpgt_epi64(b.r, a.r))}; }
inline Whole select(Mask m, Whole yes, Whole no) {
    return {_mm256_blendv_epi8(no.r, yes.r, _mm256_castpd_si256(m.m))};
}

#else

struct Mask {
    bool m[4];
    unsigned bits() const { return m[0] | m[1] << 1 | m[2] << 2 | m[3] << 3; }
};
#define ROCKING_EACH for (int i = 0; i < 4; ++i)
inline Mask operator|(Mask a, Mask b) { ROCKING_EACH a.m[i] = a.m[i] || b.m[i]; return a; }
inline Mask operator&(Mask a, Mask b) { ROCKING_EACH a.m[i] = a.m[i] && b.m[i]; return a; }
inline Mask operator!(Mask a) { ROCKING_EACH a.m[i] = !a.m[i]; return a; }

struct Pack {
    static constexpr int width = 4;
    double r[4];
    Pack() = default;
    Pack(double v) { ROCKING_EACH r[i] = v; }
    static Pack load(const double* p) { Pack a; ROCKING_EACH a.r[i] = p[i]; return a; }
    static Pack load_any(const double* p) { return load(p); }
    void store(double* p) const { ROCKING_EACH p[i] = r[i]; }
    void store_where(Mask where, double* p) const { ROCKING_EACH p[i] = where.m[i] ? r[i] : p[i]; }
    static Pack gather(const double* base, const std::int64_t* k) { Pack a; ROCKING_EACH a.r[i] = base[k[i]]; return a; }
    static void pairs(const double* base, const std::int64_t* k, Pack& first, Pack& second) {
        ROCKING_EACH first.r[i] = base[k[i]], second.r[i] = base[k[i] + 1];
    }
};
#if defined(__FP_FAST_FMA)
#define ROCKING_SCALAR_FMA(a, b, c) std::fma(a, b, c)
#else
#define ROCKING_SCALAR_FMA(a, b, c) ((a) * (b) + (c))
#endif
inline Pack operator+(Pack a, Pack b) { ROCKING_EACH a.r[i] += b.r[i]; return a; }
inline Pack operator-(Pack a, Pack b) { ROCKING_EACH a.r[i] -= b.r[i]; return a; }
inline Pack operator*(Pack a, Pack b) { ROCKING_EACH a.r[i] *= b.r[i]; return a; }
inline Pack operator/(Pack a, Pack b) { ROCKING_EACH a.r[i] /= b.r[i]; return a; }
inline Pack fma(Pack a, Pack b, Pack c) { ROCKING_EACH a.r[i] = ROCKING_SCALAR_FMA(a.r[i], b.r[i], c.r[i]); return a; }
inline Pack fnma(Pack a, Pack b, Pack c) { ROCKING_EACH a.r[i] = ROCKING_SCALAR_FMA(-a.r[i], b.r[i], c.r[i]); return a; }
inline Pack abs(Pack a) { ROCKING_EACH a.r[i] = std::fabs(a.r[i]); return a; }
inline Pack sqrt(Pack a) { ROCKING_EACH a.r[i] = std::sqrt(a.r[i]); return a; }
inline Pack min(Pack a, Pack b) { ROCKING_EACH a.r[i] = a.r[i] < b.r[i] ? a.r[i] : b.r[i]; return a; }
inline Pack max(Pack a, Pack b) { ROCKING_EACH a.r[i] = a.r[i] > b.r[i] ? a.r[i] : b.r[i]; return a; }
inline Mask operator<(Pack a, Pack b) { Mask m; ROCKING_EACH m.m[i] = a.r[i] < b.r[i]; return m; }
inline Mask operator>(Pack a, Pack b) { Mask m; ROCKING_EACH m.m[i] = a.r[i] > b.r[i]; return m; }
inline Mask operator>=(Pack a, Pack b) { Mask m; ROCKING_EACH m.m[i] = a.r[i] >= b.r[i]; return m; }
inline Mask operator==(Pack a, Pack b) { Mask m; ROCKING_EACH m.m[i] = a.r[i] == b.r[i]; return m; }
inline Pack select(Mask m, Pack yes, Pack no) { ROCKING_EACH no.r[i] = m.m[i] ? yes.r[i] : no.r[i]; return no; }

struct Whole {
    std::int64_t r[4];
    static Whole load(const std::int64_t* p) { Whole a; ROCKING_EACH a.r[i] = p[i]; return a; }
    void store(std::int64_t* p) const { ROCKING_EACH p[i] = r[i]; }
    Whole plus(std::int64_t n, Mask where) const { Whole a; ROCKING_EACH a.r[i] = r[i] + (where.m[i] ? n : 0); return a; }
};
inline Mask operator>=(Whole a, Whole b) { Mask m; ROCKING_EACH m.m[i] = a.r[i] >= b.r[i]; return m; }
inline Whole select(Mask m, Whole yes, Whole no) { ROCKING_EACH no.r[i] = m.m[i] ? yes.r[i] : no.r[i]; return no; }

#endif

inline double fma(double a, double b, double c) { return ROCKING_SCALAR_FMA(a, b, c); }

}  // namespace ROCKING_ISA
}  // namespace rocking
