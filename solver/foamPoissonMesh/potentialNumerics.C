// SPDX-License-Identifier: GPL-3.0-or-later
#include "foamPoissonMesh/potentialNumerics.H"

#include "settings/checkedDictionary.H"

#include "electrostatics/text.hpp"

#include "lduMatrix.H"

#include <algorithm>
#include <sstream>
#include <vector>

namespace him {

namespace {

/// Leaves an error of about 4e-4 in the field, a tenth of what the mesh methods make themselves; measured in
/// solver/doc/poisson.md.
constexpr double defaultTolerance = 1e-4;

const char* const knownLaplacians = "Gauss linear followed by corrected, uncorrected, orthogonal, limited <number> or "
                                    "limited corrected <number>, with a "
                                    "number from 0 to 1";

/// The limiter that a scheme names; nothing when it is not one of the known ones.
std::optional<double> limitOf(const std::vector<std::string>& words)
{
    if (words.size() < 3 || words[0] != "Gauss") {
        return {};
    }
    const std::string& kind = words[2];
    if (words.size() == 3) {
        if (kind == "corrected") {
            return 1;
        }
        return kind == "uncorrected" || kind == "orthogonal" ? std::optional<double>(0) : std::nullopt;
    }
    const bool named = words.size() == 5 && words[3] == "corrected";
    if (kind != "limited" || !(named || words.size() == 4)) {
        return {};
    }
    std::istringstream number(words.back());
    double limit = -1;
    const bool read = number >> limit && number.eof();
    return read && limit >= 0 && limit <= 1 ? std::optional<double>(limit) : std::nullopt;
}

/// The entry `name` of one group of schemes, or its default, or `standard`.
std::string schemeOf(checkedDictionary schemes, const std::string& name, const std::string& standard)
{
    const std::string own = schemes.written(name);
    const std::string common = schemes.written("default");
    if (!own.empty()) {
        return own;
    }
    return common.empty() || common == "none" ? standard : common;
}

void readSchemes(const Foam::fileName& casePath, const Foam::fileName& file, potentialNumerics& numerics,
                 Complaints& complaints)
{
    const bool exists = checkedDictionary::exists(casePath, file);
    checkedDictionary schemes = exists ? checkedDictionary(casePath, file, complaints) : checkedDictionary(complaints);
    numerics.gradient = schemeOf(schemes.section("gradSchemes", true), "grad(electricPotential)", "Gauss linear");
    const std::string laplacian =
        schemeOf(schemes.section("laplacianSchemes", true), "laplacian(electricPotential)", "Gauss linear corrected");
    const std::vector<std::string> words = wordsOf(laplacian);
    const std::optional<double> limit = limitOf(words);
    if (!limit) {
        complaints.add(file + ": laplacianSchemes: laplacian(electricPotential)",
                       "found `" + laplacian + "`, but the known schemes are " + knownLaplacians + ".");
    }
    numerics.nonOrthogonalLimit = limit.value_or(1);
    numerics.minimumCorrection = limit && words.back() == "orthogonal";
}

}  // namespace

double toleranceFor(double accuracy)
{
    constexpr double share = 0.1;
    constexpr double leftOfTolerance = 4;
    constexpr double loosest = 1e-3;
    return std::min(loosest, share * accuracy / leftOfTolerance);
}

potentialNumerics readPotentialNumerics(const Foam::fileName& casePath, const Foam::fileName& folder,
                                        Complaints& complaints)
{
    potentialNumerics numerics;
    readSchemes(casePath, folder / "fvSchemes", numerics, complaints);

    const Foam::fileName file = folder / "fvSolution";
    const bool exists = checkedDictionary::exists(casePath, file);
    checkedDictionary solution = exists ? checkedDictionary(casePath, file, complaints) : checkedDictionary(complaints);
    checkedDictionary solver = solution.section("solvers", true).section("electricPotential", true);
    numerics.tolerance = defaultTolerance;
    if (solver.readable()) {
        std::vector<std::string> known;
        for (const Foam::word& name : Foam::lduMatrix::solver::symMatrixConstructorTablePtr_->sortedToc()) {
            known.push_back(name);
        }
        solver.oneOf("solver", known);
        numerics.tolerance = solver.positive("tolerance", defaultTolerance);
        numerics.toleranceGiven = solver.has("tolerance");
        numerics.solver = solver.contents();
    }
    checkedDictionary corrections = solution.section("HIM", true);
    const long notGiven = -1;
    const long correctors = corrections.nonNegativeInteger("nNonOrthogonalCorrectors", notGiven);
    if (correctors != notGiven) {
        numerics.nonOrthogonalCorrectors = correctors;
    }
    numerics.directSolve = corrections.oneOf("directSolve", {"auto", "no"}, "auto") == "auto";
    numerics.resolveAbove = corrections.has("resolveAbove") ? corrections.positive("resolveAbove", 1) : 0;
    corrections.refuseUnknownEntries();
    return numerics;
}

}  // namespace him
