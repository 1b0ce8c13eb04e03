// SPDX-License-Identifier: GPL-3.0-or-later
#include "himField/referenceField.H"

#include "himField/timedMethod.H"
#include "settings/checkedDictionary.H"

#include "electrostatics/reference/grounded_box.hpp"
#include "electrostatics/reference/grounded_sphere.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace him {

namespace {

/// Up to this many particles are all judged; of more, `sample` evenly spaced rows are.
constexpr Index judgeAll = 20000;
constexpr Index sample = 2000;

/// Clouds of the strict p3m against the largest clouds compared, and their least size in cells.
constexpr double strictness = 1.5;
constexpr double leastStrictCells = 6;

std::vector<Index> judgedRows(Index total)
{
    const Index count = total <= judgeAll ? total : sample;
    std::vector<Index> rows(static_cast<std::size_t>(count));
    for (Index n = 0; n < count; ++n) {
        rows[static_cast<std::size_t>(n)] = n * total / count;
    }
    return rows;
}

Points rowsOf(const Points& all, const std::vector<Index>& rows)
{
    Points some(static_cast<Index>(rows.size()), 3);
    for (std::size_t n = 0; n < rows.size(); ++n) {
        some.row(static_cast<Index>(n)) = all.row(rows[n]);
    }
    return some;
}

referenceField exactInBox(const snapshot& s, const BoxSides& sides, const particleTable& table, Index total)
{
    referenceField reference;
    reference.description = "the exact field of the box (Ewald sum in its modes)";
    reference.rows = judgedRows(total);
    if (Foam::Pstream::master()) {
        const GroundedBox box(s.box, s.choices.selected.permittivity, sides);
        Scalars potential;
        if (total <= judgeAll) {
            box.compute(table.position, table.charge, reference.field, potential);
        } else {
            box.computeAt(table.position, table.charge, rowsOf(table.position, reference.rows), reference.rows,
                          reference.field, potential);
        }
        reference.field.rowwise() += s.choices.selected.externalField.transpose().array();
    }
    return reference;
}

referenceField exactInSphere(const snapshot& s, const sphericalSpace& sphere, const particleTable& table, Index total)
{
    referenceField reference;
    reference.description = "the exact field of the sphere (Kelvin images; the mesh has flat faces)";
    reference.rows = judgedRows(total);
    if (Foam::Pstream::master()) {
        Points all;
        Scalars potential;
        computeInGroundedSphere(sphere.centre, sphere.radius, s.choices.selected.permittivity, table.position,
                                table.charge, all, potential);
        reference.field = rowsOf(all, reference.rows);
        reference.field.rowwise() += s.choices.selected.externalField.transpose().array();
    }
    return reference;
}

/// By one of the field methods. Collective.
referenceField byMethod(snapshot& s, const FieldSettings& settings, const std::string& description,
                        const particleShares& shares, MPI_Comm communicator)
{
    referenceField reference;
    reference.description = description;
    reference.rows = judgedRows(shares.total());
    if (s.poisson) {
        s.poisson->forgetPotential();
    }
    timedMethod method(settings, s, communicator);
    method.call(shares.own());
    const Points all = shares.gathered(method.result().field);
    if (Foam::Pstream::master()) {
        reference.field = rowsOf(all, reference.rows);
    }
    return reference;
}

FieldSettings strictP3m(const snapshot& s, const std::vector<FieldSettings>& compared)
{
    FieldSettings strict = s.choices.selected;
    strict.method = "p3m";
    strict.p3m = {};
    strict.p3m.cloudCells = leastStrictCells;
    for (const FieldSettings& settings : compared) {
        if (settings.method == "p3m") {
            const double cells =
                settings.p3m.cloudRadius > 0 ? settings.p3m.cloudRadius / s.cellSize : settings.p3m.cloudCells;
            strict.p3m.cloudCells = std::max(strict.p3m.cloudCells, strictness * cells);
        }
    }
    strict.p3m.cloudExponent = 2;
    strict.p3m.gather = PolynomialOrder::quartic;
    strict.p3m.deferredCorrection = true;
    return s.complete(strict);
}

bool known(const std::string& method)
{
    const std::vector<std::string>& names = FieldMethod::names();
    return std::find(names.begin(), names.end(), method) != names.end();
}

}  // namespace

errorNorms normsOf(const Points& vectors)
{
    if (vectors.rows() == 0) {
        return {};
    }
    const Scalars squares = vectors.square().rowwise().sum();
    return {std::sqrt(squares.mean()), std::sqrt(squares.maxCoeff())};
}

referenceField findReference(snapshot& s, const particleTable& table, const particleShares& shares,
                             const std::vector<FieldSettings>& compared, MPI_Comm communicator)
{
    if (const std::optional<BoxSides> sides = rectangularBox(s)) {
        return exactInBox(s, *sides, table, shares.total());
    }
    if (const std::optional<sphericalSpace> sphere = groundedSphere(s); sphere && shares.total() <= judgeAll) {
        return exactInSphere(s, *sphere, table, shares.total());
    }
    if (!s.poisson && !s.periodic[0] && !s.periodic[1] && !s.periodic[2]) {
        FieldSettings all = s.choices.selected;
        all.method = "pairwiseSum";
        all.pairwiseSum = {};
        return byMethod(s, all, "the sum over all pairs, exact in free space", shares, communicator);
    }
    if (s.poisson && known("p3m")) {
        const FieldSettings strict = strictP3m(s, compared);
        if (FieldMethod::check(strict, s.poisson.get(), s.box, s.periodic).none()) {
            return byMethod(s, strict,
                            "p3m with clouds of " + shown(strict.p3m.cloudCells)
                                + " cells, quartic gather and deferred correction (stricter than all others here, but "
                                  "not exact)",
                            shares, communicator);
        }
    }
    return {};
}

}  // namespace him
