// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/electrostatics/pair_sums.hpp"

#include "electrostatics/constants.hpp"

#include <cmath>
#include <random>

namespace him {

BruteForce bruteForce(const ChargedPoints& points, double cutoff, double permittivity, bool withoutDoubleCount)
{
    const double constant = 1.0 / (4.0 * pi * permittivity);
    BruteForce result;
    result.field.setZero(points.targets, 3);
    result.potential.setZero(points.targets);
    result.fieldScale.setZero(points.targets);
    result.potentialScale.setZero(points.targets);
    for (Index i = 0; i < points.targets; ++i) {
        for (Index k = 0; k < points.position.rows(); ++k) {
            if (i == k) {
                continue;
            }
            const Vector3 d = (points.position.row(i) - points.position.row(k)).matrix();
            const double r2 = d.x() * d.x() + d.y() * d.y() + d.z() * d.z();
            if (r2 > cutoff * cutoff) {
                continue;
            }
            const double q = constant * points.charge[k];
            Vector3 field = q * d / std::pow(std::sqrt(r2), 3);
            result.fieldScale[i] += std::abs(q) / r2;
            if (withoutDoubleCount) {
                const Vector3 c = (points.cellCentre.row(i) - points.cellCentre.row(k)).matrix();
                if (c.norm() > 0.0) {
                    field -= q * c / std::pow(c.norm(), 3);
                    result.fieldScale[i] += std::abs(q) / c.squaredNorm();
                }
            } else {
                result.potential[i] += q / std::sqrt(r2);
                result.potentialScale[i] += std::abs(q) / std::sqrt(r2);
            }
            result.field.row(i) += field.transpose().array();
            ++result.pairs;
        }
    }
    return result;
}

BruteForce bruteForceScreened(const ChargedPoints& points, const ChargeCloud& cloud, double permittivity)
{
    const double constant = 1.0 / (4.0 * pi * permittivity);
    BruteForce result;
    result.field.setZero(points.targets, 3);
    result.potential.setZero(points.targets);
    result.fieldScale.setZero(points.targets);
    result.potentialScale.setZero(points.targets);
    for (Index i = 0; i < points.targets; ++i) {
        for (Index k = 0; k < points.position.rows(); ++k) {
            const Vector3 d = (points.position.row(i) - points.position.row(k)).matrix();
            const double r2 = d.x() * d.x() + d.y() * d.y() + d.z() * d.z();
            if (i == k || r2 > cloud.radius() * cloud.radius()) {
                continue;
            }
            const double q = constant * points.charge[k];
            const double r = std::sqrt(r2);
            result.field.row(i) += q * cloud.shortRangeFieldCoefficient(r) * d.transpose().array();
            result.potential[i] += q * cloud.shortRangePotential(r);
            result.fieldScale[i] += std::abs(q) / r2;
            result.potentialScale[i] += std::abs(q) / r;
            ++result.pairs;
        }
    }
    return result;
}

void setCells(ChargedPoints& points, double cellEdge)
{
    points.cellCentre = ((points.position / cellEdge).floor() + 0.5) * cellEdge;
}

ChargedPoints randomPoints(Index count, double edgeX, double edgeY, double edgeZ, unsigned seed)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    ChargedPoints points;
    points.position.resize(count, 3);
    points.charge.resize(count);
    for (Index i = 0; i < count; ++i) {
        points.position.row(i) << edgeX * unit(random), edgeY * unit(random), edgeZ * unit(random);
        points.charge[i] = 1e-12 * (unit(random) - 0.4);
    }
    points.targets = count;
    setCells(points, 0.1);
    return points;
}

ChargedPoints clusteredPoints(Index count, unsigned seed)
{
    ChargedPoints points = randomPoints(count, 1.0, 1.0, 1.0, seed);
    for (Index i = 0; i < count; ++i) {
        if (i % 4 != 0) {
            points.position.row(i) = 1e-3 * points.position.row(i) + 0.31 * static_cast<double>(i % 4);
        }
    }
    setCells(points, 0.1);
    return points;
}

}  // namespace him
