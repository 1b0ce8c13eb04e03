// SPDX-License-Identifier: GPL-3.0-or-later
#include "foamPoissonMesh/meshPart.H"

namespace him {

using namespace Foam;

struct foamPoissonMesh::keptPotential : PoissonMesh::Kept {
    scalarField electricPotential, chargeDensity;
    vectorField electricField;
    bool hasPart = false;
    scalarField potential, correction, firstIncrement;
    int corrections = 0;
    IOobject::writeOption writePotential = IOobject::NO_WRITE;
    IOobject::writeOption writeCorrection = IOobject::NO_WRITE;
    std::optional<Scalars> solvedCharge, partSolvedCharge;
    bool partIsNew = true;
    bool matched = false;
    bool partIsLatest = false;
};

std::unique_ptr<PoissonMesh::Kept> foamPoissonMesh::keep() const
{
    auto kept = std::make_unique<keptPotential>();
    kept->electricPotential = electricPotential_.primitiveField();
    kept->chargeDensity = chargeDensity_.primitiveField();
    kept->electricField = electricField_.primitiveField();
    kept->hasPart = part_ != nullptr;
    if (part_) {
        kept->potential = part_->potential.primitiveField();
        kept->correction = part_->correction.primitiveField();
        kept->firstIncrement = part_->firstIncrement;
        kept->corrections = part_->corrections;
        kept->writePotential = part_->potential.writeOpt();
        kept->writeCorrection = part_->correction.writeOpt();
    }
    kept->solvedCharge = solvedCharge_;
    kept->partSolvedCharge = partSolvedCharge_;
    kept->partIsNew = partIsNew_;
    kept->matched = matched_;
    kept->partIsLatest = partIsLatest_;
    return kept;
}

void foamPoissonMesh::restore(const Kept* kept)
{
    const auto& state = dynamic_cast<const keptPotential&>(*kept);
    equation_->report(true);
    if (part_) {
        part_->equation.report(true);
    }
    electricPotential_.primitiveFieldRef() = state.electricPotential;
    electricPotential_.correctBoundaryConditions();
    chargeDensity_.primitiveFieldRef() = state.chargeDensity;
    chargeDensity_.correctBoundaryConditions();
    electricField_.primitiveFieldRef() = state.electricField;
    electricField_.correctBoundaryConditions();
    if (part_ && !state.hasPart) {
        // Nobody but the one who made it knows of this part: it serves as its start next time and is not written.
        part_->potential.writeOpt() = IOobject::NO_WRITE;
        part_->correction.writeOpt() = IOobject::NO_WRITE;
    } else if (state.hasPart) {
        // Boundary values of the mesh part are given anew with every solve.
        part_->potential.primitiveFieldRef() = state.potential;
        part_->correction.primitiveFieldRef() = state.correction;
        part_->correction.correctBoundaryConditions();
        part_->firstIncrement = state.firstIncrement;
        part_->corrections = state.corrections;
        part_->potential.writeOpt() = state.writePotential;
        part_->correction.writeOpt() = state.writeCorrection;
    }
    solvedCharge_ = state.solvedCharge;
    partSolvedCharge_ = state.partSolvedCharge;
    partIsNew_ = state.partIsNew;
    matched_ = state.matched;
    partIsLatest_ = state.partIsLatest;
}

}  // namespace him
