// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/parameters/saturation_fit.hpp"

#include "electrostatics/require.hpp"

#include <Eigen/Dense>

namespace him {

namespace {

constexpr double normalQuantile95 = 1.959963984540054;

struct Line {
    double saturation;  // [C]
    double start;       // [C]
    double squares;     // sum of squared deviations [C2]
};

/// Best q_sat and q_0 at a given y: the curve is linear in both.
Line bestLine(const Eigen::VectorXd& contacts, const Eigen::VectorXd& charges, double decay)
{
    const Eigen::VectorXd left = (-decay * contacts.array()).exp();
    Eigen::MatrixXd basis(contacts.size(), 2);
    basis << (1.0 - left.array()).matrix(), left;
    const Eigen::Vector2d best = basis.colPivHouseholderQr().solve(charges);
    return {best[0], best[1], (basis * best - charges).squaredNorm()};
}

/// y of the least squares: a scan over decades, then golden sections.
double bestDecay(const Eigen::VectorXd& contacts, const Eigen::VectorXd& charges)
{
    const double span = contacts[contacts.size() - 1] - contacts[0];
    const double slowest = std::log(1e-2 / span);
    const double fastest = std::log(1e2 / (contacts[1] - contacts[0]));
    const int steps = 200;
    const auto squares = [&](double logDecay) { return bestLine(contacts, charges, std::exp(logDecay)).squares; };
    int best = 0;
    for (int k = 1; k <= steps; ++k) {
        const auto at = [&](int n) { return squares(slowest + (fastest - slowest) * n / steps); };
        best = at(k) < at(best) ? k : best;
    }
    if (best == 0 || best == steps) {
        throw std::invalid_argument(best == 0
                                        ? "the charge readings do not bend towards saturation; record more contacts"
                                        : "the charge does not change from the second reading on; record it earlier "
                                          "and more often");
    }
    double low = slowest + (fastest - slowest) * (best - 1) / steps;
    double high = slowest + (fastest - slowest) * (best + 1) / steps;
    const double golden = 0.6180339887498949;
    while (high - low > 1e-9) {
        const double a = high - golden * (high - low);
        const double b = low + golden * (high - low);
        (squares(a) < squares(b) ? high : low) = squares(a) < squares(b) ? b : a;
    }
    return std::exp((low + high) / 2);
}

Measured within(double value, double variance)
{
    const double half = normalQuantile95 * std::sqrt(std::max(variance, 0.0));
    return {value, value - half, value + half};
}

}  // namespace

SaturationFit fitSaturation(const std::vector<double>& contacts, const std::vector<double>& charges)
{
    if (contacts.size() != charges.size()) {
        throw std::invalid_argument("the saturation fit needs one charge per number of contacts");
    }
    if (contacts.size() < 4) {
        rejectArgument("number of charge readings", "4 or more", static_cast<double>(contacts.size()));
    }
    for (std::size_t k = 1; k < contacts.size(); ++k) {
        if (!std::isgreater(contacts[k], contacts[k - 1])) {
            rejectArgument("number of contacts", "greater than that of the reading before", contacts[k]);
        }
    }
    const auto count = static_cast<Eigen::Index>(contacts.size());
    const Eigen::VectorXd n = Eigen::Map<const Eigen::VectorXd>(contacts.data(), count);
    const Eigen::VectorXd q = Eigen::Map<const Eigen::VectorXd>(charges.data(), count);
    if (!(q.maxCoeff() > q.minCoeff())) {
        throw std::invalid_argument("all charge readings are the same: they hold no charging efficiency");
    }
    const double decay = bestDecay(n, q);
    const Line best = bestLine(n, q, decay);

    // Covariance of the parameters from the derivatives of the curve, scaled to order one.
    const Eigen::ArrayXd left = (-decay * n.array()).exp();
    Eigen::MatrixXd slopes(count, 3);
    slopes << (1.0 - left).matrix(), left.matrix(), (-(best.start - best.saturation) * n.array() * left).matrix();
    const Eigen::Vector3d scale = slopes.colwise().norm().cwiseMax(1e-300);
    slopes = slopes * scale.cwiseInverse().asDiagonal();
    const Eigen::Matrix3d inverse = (slopes.transpose() * slopes).inverse();
    const double scatter = best.squares / static_cast<double>(count - 3);
    const auto variance = [&](int k) { return scatter * inverse(k, k) / (scale[k] * scale[k]); };
    return {within(best.saturation, variance(0)), within(best.start, variance(1)), within(decay, variance(2)),
            std::sqrt(best.squares / static_cast<double>(count))};
}

}  // namespace him
