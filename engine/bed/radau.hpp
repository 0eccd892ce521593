// Radau IIA method with five stages (order 9, L-stable, stiffly accurate) for small systems, with its collocation
// polynomial.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace rocking::bed {

constexpr int kStages = 5;
template <std::size_t N>
using Vector = std::array<double, N>;

// Collocation at the zeros of the Radau polynomial. The matrices were computed from the nodes with 60 digits.
namespace radau {
constexpr double node[kStages] = {0.057104196114517682193, 0.27684301363812382768, 0.58359043236891682006, 0.86024013565621944785, 1.0};
constexpr double weight[kStages] = {0.14371356079122594132, 0.28135601514946206019, 0.31182652297574125408, 0.22310390108357074440, 0.04};
constexpr double matrix[kStages][kStages] = {
    {0.072998864317903324306, -0.026735331107945571878, 0.018676929763984354412, -0.012879106093306439854, 0.0050428392338820152067},
    {0.15377523147918246867, 0.14621486784749350665, -0.036444568905128089527, 0.021233063119304719422, -0.0079355799027287775326},
    {0.14006304568480987151, 0.29896712949128347940, 0.16758507013524896344, -0.033969101686617746572, 0.010944288744192252274},
    {0.14489430810953475754, 0.27650006876015922756, 0.32579792291042102998, 0.12875675325490976116, -0.015708917378805328388},
    {0.14371356079122594132, 0.28135601514946206019, 0.31182652297574125408, 0.22310390108357074440, 0.040000000000000000000}};
constexpr double real_value = 6.2867047517292766452;
constexpr double pair_value[2][2] = {{5.7009532986717894192, 3.2102656003085498884}, {3.6556943254635722582, 6.5437368993600772940}};
constexpr double real_column[kStages] = {0.014095374796435410254, 0.0016796888388262727228, 0.082180931923793191854, 0.42800035161672630350,
                                         1.0381905073028799693};
constexpr double real_row[kStages] = {26.678816248898343435, 12.313094582721913008, 3.0904630355836903355, -0.91648922385237143501,
                                      0.71427208283041148711};
constexpr double pair_column[2][2][kStages] = {
    {{-0.015142665487404053726, -0.0038614018009014264111, 0.036257960276540691733, 0.48297906367593819820, 1.0949964805835385189},
     {0.013244498164569814299, -0.028463631760094341474, -0.086009976459701793864, -0.14382512166787073291, 0.18357757380220086470}},
    {{-0.026218308774794351222, 0.053722811608485234988, -0.069342120536263027256, -0.22718927660667722183, 0.061688142621309704060},
     {0.0025559782086639331042, -0.021108543714828349876, 0.11739464960854352685, -0.23160764866276633655, -0.53669844624693841674}}};
constexpr double pair_row[2][2][kStages] = {
    {{-15.316402447345003956, -6.9955179371231091760, 0.066122388617307662934, 0.13605181698386248418, 0.15794452005766573004},
     {-1.3643641927321990307, 5.6020416722090600130, 0.86322262119814475448, 1.0816198604930900066, -0.50477497010826226240}},
    {{-2.8814480023513223801, 4.1495479596138108319, 0.63941749744008651441, -0.97770998237502318808, 0.38485945281983334867},
     {5.3099546200869013269, 3.8025634167645047924, -2.9022343000964903032, 1.0911960190048693417, -0.29836227748865164334}}};
constexpr double error_row[kStages] = {-4.4189977167963817226, 0.57923485225667005447, -0.19923756095346800874, 0.094167483691945488975,
                                       -0.031813168885493824096};
constexpr double dense[kStages][kStages] = {
    {27.780933944064637305, -3.6414784980492131527, 1.2525477211691187205, -0.59200316718454287257, 0.2},
    {-208.02785730090133638, 77.883376055117827854, -29.167414317829696830, 14.111895563613205358, -4.8},
    {524.18788396949183166, -264.89491356822635190, 137.90290440413478440, -72.395874805400264155, 25.2},
    {-543.82835603613249205, 317.67586907995273383, -202.09087094360742643, 123.04335789978718465, -44.8},
    {199.88739542347735947, -127.02285306879499662, 92.102833136133220138, -64.167375490815582985, 25.2}};
}  // namespace radau

struct Complex {
    double re = 0.0, im = 0.0;
};
inline Complex operator+(Complex a, Complex b) { return {a.re + b.re, a.im + b.im}; }
inline Complex operator-(Complex a, Complex b) { return {a.re - b.re, a.im - b.im}; }
inline Complex operator*(Complex a, Complex b) { return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re}; }
inline Complex inverse(Complex a) {
    const double d = a.re * a.re + a.im * a.im;
    return {a.re / d, -a.im / d};
}
inline double inverse(double a) { return 1.0 / a; }
inline double size(Complex a) { return std::abs(a.re) + std::abs(a.im); }
inline double size(double a) { return std::abs(a); }

// LU factorization of a small matrix, with row pivots.
template <std::size_t N, class T>
struct Solver {
    T a[N][N];
    T pivot[N];
    std::size_t row[N];
    void factor() {
        for (std::size_t i = 0; i < N; ++i) row[i] = i;
        for (std::size_t k = 0; k < N; ++k) {
            std::size_t best = k;
            for (std::size_t i = k + 1; i < N; ++i)
                if (size(a[i][k]) > size(a[best][k])) best = i;
            if (best != k) {
                std::swap(row[k], row[best]);
                for (std::size_t j = 0; j < N; ++j) std::swap(a[k][j], a[best][j]);
            }
            pivot[k] = inverse(a[k][k]);
            for (std::size_t i = k + 1; i < N; ++i) {
                a[i][k] = a[i][k] * pivot[k];
                for (std::size_t j = k + 1; j < N; ++j) a[i][j] = a[i][j] - a[i][k] * a[k][j];
            }
        }
    }
    void solve(std::array<T, N>& x) const {
        std::array<T, N> y;
        for (std::size_t i = 0; i < N; ++i) {
            y[i] = x[row[i]];
            for (std::size_t j = 0; j < i; ++j) y[i] = y[i] - a[i][j] * y[j];
        }
        for (std::size_t i = N; i-- > 0;) {
            for (std::size_t j = i + 1; j < N; ++j) y[i] = y[i] - a[i][j] * x[j];
            x[i] = y[i] * pivot[i];
        }
    }
};

// Solves (lambda / h - J) x = r for a state of two positions and three velocities: elimination of the positions leaves
// three rows. The effect of the positions on their own rates is neglected; Newton's method corrects this error.
template <class T>
class Reduced {
public:
    void set(T value, const double (&jacobian)[5][5]) {
        back_ = inverse(value);
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) {
                double through = 0.0;
                for (int q = 0; q < 2; ++q) through += jacobian[2 + i][q] * jacobian[q][2 + j];
                const T sum = back_ * T{through};
                inner_.a[i][j] = (i == j ? value : T{}) - T{jacobian[2 + i][2 + j]} - sum;
            }
        inner_.factor();
        jacobian_ = &jacobian;
    }
    void solve(std::array<T, 5>& x) const {
        const auto& jacobian = *jacobian_;
        const T p[2] = {back_ * x[0], back_ * x[1]};
        std::array<T, 3> v;
        for (int i = 0; i < 3; ++i) v[i] = x[2 + i] + T{jacobian[2 + i][0]} * p[0] + T{jacobian[2 + i][1]} * p[1];
        inner_.solve(v);
        for (int q = 0; q < 2; ++q) {
            T sum{};
            for (int j = 0; j < 3; ++j) sum = sum + T{jacobian[q][2 + j]} * v[j];
            x[q] = p[q] + back_ * sum;
        }
        for (int i = 0; i < 3; ++i) x[2 + i] = v[i];
    }

private:
    T back_{};
    Solver<3, T> inner_;
    const double (*jacobian_)[5][5] = nullptr;
};

// One step: stages, end and error estimate of y' = f(y).
template <std::size_t N>
struct Step {
    Vector<N> start, stage[kStages];  // stage[k]: state at node k; the last stage is the end of the step
    double h = 0.0, error = 0.0;
    const Vector<N>& end() const { return stage[kStages - 1]; }
    Vector<N> at(double tau) const {
        double share[kStages];
        for (int j = 0; j < kStages; ++j) {
            double sum = 0.0;
            for (int i = kStages; i-- > 0;) sum = sum * tau + radau::dense[i][j];
            share[j] = sum * tau;
        }
        Vector<N> y = start;
        for (std::size_t i = 0; i < N; ++i)
            for (int j = 0; j < kStages; ++j) y[i] += share[j] * (stage[j][i] - start[i]);
        return y;
    }
};

// Rates and their derivatives at a state, used by all steps from this state.
template <std::size_t N>
struct Tangent {
    Vector<N> slope;
    double jacobian[N][N];
};

template <std::size_t N, class Field>
Tangent<N> tangent(const Field& f, const Vector<N>& y, const Vector<N>& nudge) {
    Tangent<N> t;
    t.slope = f(y);
    for (std::size_t j = 0; j < N; ++j) {
        Vector<N> moved = y;
        moved[j] += nudge[j];
        const double by = moved[j] - y[j];
        const Vector<N> there = f(moved);
        for (std::size_t i = 0; i < N; ++i) t.jacobian[i][j] = (there[i] - t.slope[i]) / by;
    }
    return t;
}

// Initial values of Newton's method: states at the nodes, from the polynomial of a step that contains or precedes them.
template <std::size_t N>
struct Guess {
    bool any = false;
    Vector<N> stage[kStages];
};

// Simplified Newton method for the collocation equations; false if it does not converge. `unit`: allowed error per
// component. `contraction`: ratio of successive changes in the previous step; on return in this step.
template <std::size_t N, class Field>
bool take_step(const Field& f, const Vector<N>& y, double h, const Vector<N>& unit, const Tangent<N>& local, const Guess<N>& guess,
               double& contraction, Step<N>& out) {
    Reduced<double> first;
    Reduced<Complex> other[2];
    first.set(radau::real_value / h, local.jacobian);
    for (int q = 0; q < 2; ++q) other[q].set(Complex{radau::pair_value[q][0] / h, radau::pair_value[q][1] / h}, local.jacobian);
    double z[kStages][N] = {};
    Vector<N> w{};
    std::array<Complex, N> v[2]{};
    if (guess.any)
        for (int k = 0; k < kStages; ++k)
            for (std::size_t i = 0; i < N; ++i) {
                z[k][i] = guess.stage[k][i] - y[i];
                w[i] += radau::real_row[k] * z[k][i];
                for (int q = 0; q < 2; ++q) {
                    v[q][i].re += radau::pair_row[q][0][k] * z[k][i];
                    v[q][i].im += radau::pair_row[q][1][k] * z[k][i];
                }
            }
    bool settled = false;
    double before = 0.0;
    for (int round = 0; round < 12 && !settled; ++round) {
        Vector<N> force[kStages];
        for (int k = 0; k < kStages; ++k) {
            Vector<N> state = y;
            for (std::size_t i = 0; i < N; ++i) state[i] += z[k][i];
            force[k] = f(state);
        }
        Vector<N> dw;
        std::array<Complex, N> dv[2];
        for (std::size_t i = 0; i < N; ++i) {
            double sum = -radau::real_value / h * w[i];
            for (int k = 0; k < kStages; ++k) sum += radau::real_row[k] * force[k][i];
            dw[i] = sum;
            for (int q = 0; q < 2; ++q) {
                Complex total = Complex{} - Complex{radau::pair_value[q][0] / h, radau::pair_value[q][1] / h} * v[q][i];
                for (int k = 0; k < kStages; ++k) {
                    total.re += radau::pair_row[q][0][k] * force[k][i];
                    total.im += radau::pair_row[q][1][k] * force[k][i];
                }
                dv[q][i] = total;
            }
        }
        first.solve(dw);
        other[0].solve(dv[0]);
        other[1].solve(dv[1]);
        double change = 0.0;
        for (std::size_t i = 0; i < N; ++i) {
            w[i] += dw[i];
            for (int q = 0; q < 2; ++q) v[q][i] = Complex{v[q][i].re + dv[q][i].re, v[q][i].im + dv[q][i].im};
            for (int k = 0; k < kStages; ++k) {
                double dz = radau::real_column[k] * dw[i];
                for (int q = 0; q < 2; ++q) dz += 2.0 * (radau::pair_column[q][0][k] * dv[q][i].re - radau::pair_column[q][1][k] * dv[q][i].im);
                z[k][i] += dz;
                change = std::max(change, std::abs(dz) / unit[i]);
            }
        }
        if (!(change < 1e30)) return false;
        if (round > 0) contraction = before > 0.0 ? std::max(change / before, 0.1 * contraction) : contraction;
        if (round > 1 && contraction > 2.0) return false;
        // the remaining change is about rate / (1 - rate) times the last change
        settled = change <= 1e-3 || (contraction < 0.5 && change * contraction / (1.0 - contraction) <= 1e-2);
        before = change;
    }
    if (!settled) return false;
    out.start = y;
    out.h = h;
    for (int k = 0; k < kStages; ++k)
        for (std::size_t i = 0; i < N; ++i) out.stage[k][i] = y[i] + z[k][i];  // Eq. 131
    Vector<N> gap;
    for (std::size_t i = 0; i < N; ++i) {
        gap[i] = local.slope[i];
        for (int k = 0; k < kStages; ++k) gap[i] += radau::real_value / h * radau::error_row[k] * z[k][i];
    }
    first.solve(gap);
    out.error = 0.0;
    for (std::size_t i = 0; i < N; ++i) out.error = std::max(out.error, std::abs(gap[i]) / unit[i]);
    return true;
}

}  // namespace rocking::bed
