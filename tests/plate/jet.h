#pragma once
#include <array>
#include <cmath>

namespace palp {

/// A function of (x, z) near one place: its Taylor coefficients up to total degree 4, so that sums, products and
/// smooth functions of jets carry exact derivatives.
class Jet {
public:
    static constexpr int kDegree = 4;

    Jet(double value = 0) { at(0, 0) = value; } // NOLINT: numbers are constant functions
    static Jet x(double value) { return variable(value, 1, 0); }
    static Jet z(double value) { return variable(value, 0, 1); }

    /// The derivative of order m in x and n in z at the place.
    [[nodiscard]] double derivative(int m, int n) const { return at(m, n) * factorial(m) * factorial(n); }

    /// The derivative as a function; its coefficients are exact up to degree 4 - m - n.
    [[nodiscard]] Jet differentiated(int m, int n) const
    {
        Jet result;
        for (int i = m; i <= kDegree; ++i)
            for (int j = n; i + j <= kDegree; ++j)
                result.at(i - m, j - n) = at(i, j) * factorial(i) / factorial(i - m) * factorial(j) / factorial(j - n);
        return result;
    }

    /// g(this) from the values g, g', .. g'''' at this jet's value.
    [[nodiscard]] Jet through(const std::array<double, kDegree + 1>& g) const
    {
        Jet change = *this, power = 1, result;
        change.at(0, 0) = 0;
        for (int k = 0; k <= kDegree; ++k) {
            result = result + power * (g[std::size_t(k)] / factorial(k));
            power  = power * change;
        }
        return result;
    }

    friend Jet operator+(const Jet& a, const Jet& b)
    {
        Jet sum;
        for (std::size_t k = 0; k < a.c_.size(); ++k) sum.c_[k] = a.c_[k] + b.c_[k];
        return sum;
    }
    friend Jet operator*(const Jet& a, const Jet& b)
    {
        Jet product;
        for (int i = 0; i <= kDegree; ++i)
            for (int j = 0; i + j <= kDegree; ++j)
                for (int m = 0; m <= i; ++m)
                    for (int n = 0; n <= j; ++n) product.at(i, j) += a.at(m, n) * b.at(i - m, j - n);
        return product;
    }
    friend Jet operator-(const Jet& a, const Jet& b) { return a + b * -1.0; }

    [[nodiscard]] double value() const { return at(0, 0); }

private:
    static Jet variable(double value, int m, int n)
    {
        Jet jet(value);
        jet.at(m, n) = 1;
        return jet;
    }
    static double factorial(int n) { return n < 2 ? 1 : n * factorial(n - 1); }

    double&       at(int m, int n) { return c_[std::size_t(m * (kDegree + 1) + n)]; }
    const double& at(int m, int n) const { return c_[std::size_t(m * (kDegree + 1) + n)]; }

    std::array<double, (kDegree + 1) * (kDegree + 1)> c_{}; ///< of dx^m dz^n
};

inline Jet exp(const Jet& u)
{
    const double e = std::exp(u.value());
    return u.through({e, e, e, e, e});
}
inline Jet sin(const Jet& u)
{
    const double s = std::sin(u.value()), c = std::cos(u.value());
    return u.through({s, c, -s, -c, s});
}
inline Jet inverse(const Jet& u)
{
    const double r = 1 / u.value();
    return u.through({r, -r * r, 2 * r * r * r, -6 * r * r * r * r, 24 * r * r * r * r * r});
}
inline Jet squared(const Jet& u)
{
    return u * u;
}

} // namespace palp
