// One number in place of a register, which counts the arithmetic that is done with it. Included in engine/pack.hpp.

struct Tally {
    std::int64_t sums = 0, products = 0, quotients = 0, roots = 0, fused = 0, extremes = 0;
};
inline Tally tally;

struct Mask {
    bool m;
    unsigned bits() const { return m; }
};
inline Mask operator|(Mask a, Mask b) { return {a.m || b.m}; }
inline Mask operator&(Mask a, Mask b) { return {a.m && b.m}; }
inline Mask operator!(Mask a) { return {!a.m}; }

struct Pack {
    static constexpr int width = 1;
    double r;
    Pack() = default;
    Pack(double v) : r(v) {}
    static Pack load(const double* p) { return *p; }
    static Pack load_any(const double* p) { return *p; }
    void store(double* p) const { *p = r; }
    void store_where(Mask where, double* p) const { *p = where.m ? r : *p; }
    static Pack gather(const double* base, const std::int64_t* k) { return base[*k]; }
    static void pairs(const double* base, const std::int64_t* k, Pack& first, Pack& second) {
        first = base[*k];
        second = base[*k + 1];
    }
};
inline Pack counted(std::int64_t& what, double value) { return ++what, Pack(value); }
inline Pack operator+(Pack a, Pack b) { return counted(tally.sums, a.r + b.r); }
inline Pack operator-(Pack a, Pack b) { return counted(tally.sums, a.r - b.r); }
inline Pack operator*(Pack a, Pack b) { return counted(tally.products, a.r * b.r); }
inline Pack operator/(Pack a, Pack b) { return counted(tally.quotients, a.r / b.r); }
inline Pack fma(Pack a, Pack b, Pack c) { return counted(tally.fused, __builtin_fma(a.r, b.r, c.r)); }
inline Pack fnma(Pack a, Pack b, Pack c) { return counted(tally.fused, __builtin_fma(-a.r, b.r, c.r)); }
inline Pack sqrt(Pack a) { return counted(tally.roots, std::sqrt(a.r)); }
inline Pack min(Pack a, Pack b) { return counted(tally.extremes, a.r < b.r ? a.r : b.r); }
inline Pack max(Pack a, Pack b) { return counted(tally.extremes, a.r > b.r ? a.r : b.r); }
inline Pack abs(Pack a) { return std::fabs(a.r); }
inline Mask operator<(Pack a, Pack b) { return {a.r < b.r}; }
inline Mask operator>(Pack a, Pack b) { return {a.r > b.r}; }
inline Mask operator>=(Pack a, Pack b) { return {a.r >= b.r}; }
inline Mask operator==(Pack a, Pack b) { return {a.r == b.r}; }
inline Pack select(Mask m, Pack yes, Pack no) { return m.m ? yes : no; }
#define ROCKING_SCALAR_FMA(a, b, c) __builtin_fma(a, b, c)

struct Whole {
    std::int64_t r;
    static Whole load(const std::int64_t* p) { return {*p}; }
    void store(std::int64_t* p) const { *p = r; }
    Whole plus(std::int64_t n, Mask where) const { return {r + (where.m ? n : 0)}; }
};
inline Mask operator>=(Whole a, Whole b) { return {a.r >= b.r}; }
inline Whole select(Mask m, Whole yes, Whole no) { return m.m ? yes : no; }
