// SPDX-License-Identifier: GPL-3.0-or-later
#include "foamPoissonMesh/meshPart.H"

#include "foamPoissonMesh/meshArrays.H"

#include "extrapolatedCalculatedFvPatchFields.H"
#include "fixedGradientFvPatchFields.H"
#include "fixedValueFvPatchFields.H"

#include <stdexcept>

namespace him {

namespace {

using namespace Foam;

/// fixedValue on conductors, fixedGradient on insulated faces, else what the patch itself asks for.
wordList fieldTypes(const volScalarField& electricPotential)
{
    wordList types(electricPotential.boundaryField().size());
    forAll(types, patch)
    {
        const fvPatchScalarField& values = electricPotential.boundaryField()[patch];
        types[patch] = values.coupled()       ? values.type()
                       : isConductor(values) ? fixedValueFvPatchScalarField::typeName
                                             : fixedGradientFvPatchScalarField::typeName;
    }
    return types;
}

/// A symmetry patch takes a given gradient when the type of the patch is named besides.
wordList patchTypes(const fvMesh& mesh)
{
    wordList types(mesh.boundary().size());
    forAll(types, patch)
    {
        types[patch] = mesh.boundary()[patch].coupled() ? word::null : mesh.boundary()[patch].type();
    }
    return types;
}

volScalarField makeField(const word& name, const volScalarField& electricPotential)
{
    const fvMesh& mesh = electricPotential.mesh();
    return volScalarField(IOobject(name, mesh.time().timeName(), mesh), mesh,
                          dimensionedScalar(electricPotential.dimensions(), Zero), fieldTypes(electricPotential),
                          patchTypes(mesh));
}

/// Values of an earlier run, when it left some.
void readStart(volScalarField& field)
{
    IOobject io(field.name(), field.time().timeName(), field.mesh(), IOobject::MUST_READ, IOobject::NO_WRITE, false);
    if (returnReduce(io.typeHeaderOk<volScalarField>(true), andOp<bool>())) {
        field.primitiveFieldRef() = volScalarField(io, field.mesh()).primitiveField();
        field.correctBoundaryConditions();
    }
}

}  // namespace

foamPoissonMesh::meshPart::meshPart(const Foam::volScalarField& electricPotential, const potentialNumerics& numerics)
    : potential(makeField("meshPotential", electricPotential)),
      correction(IOobject("meshPotentialCorrection", electricPotential.time().timeName(), electricPotential.mesh()),
                 electricPotential.mesh(), dimensionedScalar(electricPotential.dimensions(), Zero),
                 extrapolatedCalculatedFvPatchScalarField::typeName),
      equation(potential, numerics)
{
    readStart(potential);
    readStart(correction);
    firstIncrement = correction.primitiveField();
}

foamPoissonMesh::meshPart& foamPoissonMesh::part()
{
    if (!part_) {
        part_ = std::make_unique<meshPart>(electricPotential_, numerics_);
    }
    return *part_;
}

const MeshArrays& foamPoissonMesh::arrays() const
{
    if (!arrays_) {
        Complaints complaints;
        refuseCouplings(electricPotential_, complaints);
        if (!complaints.none()) {
            throw std::runtime_error(complaints.text());
        }
        arrays_ = std::make_unique<MeshArrays>(makeMeshArrays(electricPotential_));
    }
    updateVoltages(electricPotential_, *arrays_);
    return *arrays_;
}

void foamPoissonMesh::setBoundaryValues(const Scalars& boundaryValue)
{
    Index row = 0;
    for (fvPatchScalarField& values : part().potential.boundaryFieldRef()) {
        if (values.coupled()) {
            continue;
        }
        auto* gradient = dynamic_cast<fixedGradientFvPatchScalarField*>(&values);
        scalarField& target = gradient ? gradient->gradient() : static_cast<scalarField&>(values);
        forAll(target, i)
        {
            target[i] = boundaryValue[row++];
        }
    }
}

void foamPoissonMesh::solve(const Scalars& cellCharge, const Scalars& boundaryValue)
{
    partIsLatest_ = true;
    partIsNew_ = mustSolve(cellCharge, partSolvedCharge_);
    if (!partIsNew_) {
        return;
    }
    setBoundaryValues(boundaryValue);
    if (directSolver* solver = direct()) {
        if (matched_ && returnReduce(bool((boundaryValue != 0).any()), orOp<bool>())) {
            throw std::logic_error("the matched operator knows walls at 0 V only");
        }
        Scalars source = cellCharge / permittivity_;
        if (!matched_) {
            solver->addBoundaryValues(arrays().boundary, boundaryValue, source);
        }
        Scalars values;
        solver->solve(source, matched_ ? directSolver::Operator::matched : directSolver::Operator::finiteVolume, values);
        std::copy(values.begin(), values.end(), part().potential.primitiveFieldRef().begin());
        part().potential.correctBoundaryConditions();
        finishPart();
        return;
    }
    scalarField source = sourceOf(cellCharge);
    if (!potentialIsFixed_) {
        balance(source, part().equation.boundaryFlux());
    }
    part().equation.solve(source);
    finishPart();
}

void foamPoissonMesh::finishPart()
{
    part().correction = dimensionedScalar(part().correction.dimensions(), Zero);
    part().corrections = 0;
    part().potential.writeOpt() = IOobject::AUTO_WRITE;
    partIsLatest_ = true;
}

void foamPoissonMesh::correct(const Scalars& residual)
{
    if (!partIsNew_) {
        return;  // the last potential has its correction
    }
    if (directSolver* solver = direct()) {
        Scalars values;
        solver->solve(residual / permittivity_, directSolver::Operator::finiteVolume, values);
        forAll(part().correction, cell)
        {
            part().correction[cell] += values[cell];
        }
        part().correction.correctBoundaryConditions();
        part().correction.writeOpt() = IOobject::AUTO_WRITE;
        return;
    }
    scalarField source(mesh_.nCells());
    forAll(source, cell)
    {
        source[cell] = -residual[cell] / permittivity_;
    }
    if (!potentialIsFixed_) {
        balance(source, 0);
    }
    // The first correction after a solve is much like the one of the solve before.
    scalarField increment(mesh_.nCells(), Zero);
    scalarField& values = part().corrections++ == 0 ? part().firstIncrement : increment;
    part().equation.solveIncrement(values, source);
    part().correction.primitiveFieldRef() += values;
    part().correction.correctBoundaryConditions();
    part().correction.writeOpt() = IOobject::AUTO_WRITE;
}

}  // namespace him
