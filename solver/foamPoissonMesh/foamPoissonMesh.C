// SPDX-License-Identifier: GPL-3.0-or-later
#include "foamPoissonMesh/foamPoissonMesh.H"

#include "foamPoissonMesh/conversions.H"
#include "foamPoissonMesh/meshArrays.H"
#include "foamPoissonMesh/meshPart.H"
#include "settings/checkedDictionary.H"

#include "extrapolatedCalculatedFvPatchFields.H"
#include "processorPolyPatch.H"

#include <stdexcept>

namespace him {

namespace {

using namespace Foam;

const dimensionSet dimPotential(1, 2, -3, 0, 0, -1, 0);
const dimensionSet dimCharge(0, 0, 1, 0, 0, 1, 0);

/// A net charge above this share of all charges counts as one.
constexpr double neutrality = 1e-9;

/// A field that is written only after it has been solved for.
IOobject resultIO(const word& name, const fvMesh& mesh)
{
    return IOobject(name, mesh.time().timeName(), mesh, IOobject::NO_READ, IOobject::NO_WRITE);
}

Box boundsOf(const pointField& points)
{
    Box bounds;
    for (const point& p : points) {
        bounds.extend(toEigen(p));
    }
    return bounds;
}

/// Whether the mesh ends at conductors only, on all ranks.
bool onlyConductors(const volScalarField& potential)
{
    bool conductors = true;
    for (const fvPatchScalarField& patch : potential.boundaryField()) {
        const bool betweenRanks = isA<processorPolyPatch>(patch.patch().patch());
        conductors = conductors && (betweenRanks || (!patch.coupled() && isConductor(patch)));
    }
    return returnReduce(conductors, andOp<bool>());
}

/// Largest distance between two points of one cell, over all ranks [m].
double largestDiagonal(const fvMesh& mesh)
{
    scalar largest = 0;
    for (label cell = 0; cell < mesh.nCells(); ++cell) {
        const labelList& points = mesh.cellPoints()[cell];
        forAll(points, i)
        {
            for (label j = 0; j < i; ++j) {
                largest = max(largest, magSqr(mesh.points()[points[i]] - mesh.points()[points[j]]));
            }
        }
    }
    return std::sqrt(returnReduce(largest, maxOp<scalar>()));
}

}  // namespace

foamPoissonMesh::foamPoissonMesh(const Foam::fvMesh& mesh, double permittivity, const potentialNumerics& numerics,
                                 bool neutralisingBackground)
    : mesh_(mesh),
      permittivity_(permittivity),
      numerics_(numerics),
      neutralisingBackground_(neutralisingBackground),
      electricPotential_(
          IOobject("electricPotential", mesh.time().timeName(), mesh, IOobject::MUST_READ, IOobject::AUTO_WRITE), mesh),
      chargeDensity_(resultIO("chargeDensity", mesh), mesh, dimensionedScalar(dimCharge / dimVolume, Zero),
                     extrapolatedCalculatedFvPatchScalarField::typeName),
      electricField_(resultIO("electricField", mesh), mesh, dimensionedVector(dimPotential / dimLength, Zero),
                     extrapolatedCalculatedFvPatchVectorField::typeName),
      locator_(mesh),
      localBounds_(boundsOf(mesh.points())),
      largestCellDiagonal_(largestDiagonal(mesh)),
      potentialIsFixed_(!electricPotential_.needReference()),
      unknownToP3m_(firstConditionUnknownToP3m(electricPotential_)),
      equation_(std::make_unique<potentialEquation>(electricPotential_, numerics_))
{
}

foamPoissonMesh::~foamPoissonMesh() = default;

void foamPoissonMesh::setDielectrics(const dielectricChoices& choices, Complaints& complaints)
{
    dielectrics_ = dielectrics::create(choices, permittivity_, electricPotential_, complaints);
    if (dielectrics_) {
        numerics_.directSolve = false;
        equation_ = std::make_unique<potentialEquation>(electricPotential_, numerics_, dielectrics_.get());
        if (!dielectrics_->uniform()) {
            unknownToP3m_ =
                "zonePermittivity gives cells another permittivity than the gas, and p3m knows one in all cells";
        }
    }
}

Scalars foamPoissonMesh::withWalls(const Scalars& cellCharge) const
{
    Scalars all = cellCharge;
    if (dielectrics_) {
        dielectrics_->addShares(all);
    }
    return all;
}

std::vector<ChargedFace> foamPoissonMesh::chargedFaces() const
{
    std::vector<ChargedFace> faces;
    for (label owned = 0; dielectrics_ && owned < dielectrics_->ownedFaces(); ++owned) {
        if (dielectrics_->insideMesh(owned)) {
            faces.push_back({{}, static_cast<std::int32_t>(dielectrics_->cellOf(owned))});
            for (const label point : dielectrics_->polygonOf(owned)) {
                faces.back().corners.push_back(toEigen(mesh_.points()[point]));
            }
        }
    }
    return faces;
}

void foamPoissonMesh::faceCharges(Scalars& charge) const
{
    std::vector<double> charges;
    for (label owned = 0; dielectrics_ && owned < dielectrics_->ownedFaces(); ++owned) {
        if (dielectrics_->insideMesh(owned)) {
            charges.push_back(dielectrics_->surfaceCharge(owned) * dielectrics_->areaOf(owned));
        }
    }
    charge = Eigen::Map<const Scalars>(charges.data(), static_cast<Index>(charges.size()));
}

Vector3 foamPoissonMesh::cellCentre(Index cell) const
{
    // Not C(), which is built by all ranks together when it is first asked for.
    return toEigen(mesh_.cellCentres()[static_cast<label>(cell)]);
}

Vector3 foamPoissonMesh::electricField(Index cell) const
{
    return toEigen(electricField_[static_cast<label>(cell)]);
}

std::vector<Box> foamPoissonMesh::cellBoxes() const
{
    std::vector<Box> boxes(static_cast<std::size_t>(mesh_.nCells()));
    for (Foam::label cell = 0; cell < mesh_.nCells(); ++cell) {
        for (const Foam::label point : mesh_.cellPoints()[cell]) {
            boxes[static_cast<std::size_t>(cell)].extend(toEigen(mesh_.points()[point]));
        }
    }
    return boxes;
}

double foamPoissonMesh::potential(Index cell) const
{
    const label index = static_cast<label>(cell);
    return partIsLatest_ ? part_->potential[index] + part_->correction[index] : electricPotential_[index];
}

void foamPoissonMesh::forgetPotential()
{
    electricPotential_.primitiveFieldRef() = 0;
    equation_->report(false);
    solvedCharge_.reset();
    partSolvedCharge_.reset();
    if (part_) {
        part_->potential.primitiveFieldRef() = 0;
        part_->firstIncrement = 0;
        part_->equation.report(false);
    }
}

Box foamPoissonMesh::globalBounds() const
{
    Box box;
    box.lower = toEigen(mesh_.bounds().min());
    box.upper = toEigen(mesh_.bounds().max());
    return box;
}

void foamPoissonMesh::refuseNetCharge(const Scalars& cellCharge) const
{
    const scalar net = returnReduce(scalar(cellCharge.sum()), sumOp<scalar>());
    const scalar all = returnReduce(scalar(cellCharge.abs().sum()), sumOp<scalar>());
    if (std::abs(net) > neutrality * all) {
        throw std::runtime_error("no patch of electricPotential fixes the voltage, but the mesh holds a net charge of "
                                 + shown(net)
                                 + " C, whose field lines have nowhere to end. Give one patch a fixedValue, or write "
                                   "neutralisingBackground yes; in constant/electrostaticProperties.");
    }
}

void foamPoissonMesh::balance(Foam::scalarField& source, double boundaryFlux) const
{
    const scalar excess = returnReduce(sum(source) - boundaryFlux, sumOp<scalar>());
    source -= (excess / gSum(mesh_.V())) * mesh_.V().field();
}

bool foamPoissonMesh::mustSolve(const Scalars& cellCharge, std::optional<Scalars>& solved) const
{
    if (numerics_.resolveAbove == 0) {
        return true;
    }
    if (solved) {
        const scalar change = returnReduce(scalar((cellCharge - *solved).abs().sum()), sumOp<scalar>());
        const scalar all = returnReduce(scalar(cellCharge.abs().sum()), sumOp<scalar>());
        if (change <= numerics_.resolveAbove * all) {
            return false;
        }
    }
    solved = cellCharge;
    return true;
}

Foam::scalarField foamPoissonMesh::sourceOf(const Scalars& cellCharge) const
{
    if (!potentialIsFixed_ && !neutralisingBackground_) {
        refuseNetCharge(cellCharge);
    }
    scalarField source(mesh_.nCells());
    forAll(source, cell)
    {
        source[cell] = -cellCharge[cell] / permittivity_;
    }
    return source;
}

void foamPoissonMesh::solve(const Scalars& particleCharge)
{
    partIsLatest_ = false;
    const Scalars cellCharge = withWalls(particleCharge);
    if (dielectrics_) {
        dielectrics_->updatePatches(electricPotential_);
    }
    if (!mustSolve(cellCharge, solvedCharge_)) {
        return;
    }
    if (directSolver* solver = direct()) {
        Scalars source = cellCharge / permittivity_;
        solver->addBoundaryValues(arrays().boundary, arrays().boundary.value, source);
        Scalars values;
        solver->solve(source, directSolver::Operator::finiteVolume, values);
        std::copy(values.begin(), values.end(), electricPotential_.primitiveFieldRef().begin());
        electricPotential_.correctBoundaryConditions();
    } else {
        scalarField source = sourceOf(cellCharge);
        if (!potentialIsFixed_) {
            balance(source, equation_->boundaryFlux());
        }
        equation_->solve(source);
    }
    electricField_ = -equation_->gradient();
    forAll(chargeDensity_, cell)
    {
        chargeDensity_[cell] = particleCharge[cell] / mesh_.V()[cell];
    }
    chargeDensity_.correctBoundaryConditions();
    electricField_.writeOpt() = IOobject::AUTO_WRITE;
    chargeDensity_.writeOpt() = IOobject::AUTO_WRITE;
}

directSolver* foamPoissonMesh::direct()
{
    if (!directSought_ && numerics_.directSolve && onlyConductors(electricPotential_)) {
        direct_ = directSolver::create(arrays(), Pstream::parRun() ? MPI_COMM_WORLD : MPI_COMM_SELF);
    }
    directSought_ = true;
    return direct_.get();
}

bool foamPoissonMesh::useMatchedOperator()
{
    matched_ = direct() != nullptr;
    return matched_;
}

std::string foamPoissonMesh::description() const
{
    const std::string cells = std::to_string(returnReduce(mesh_.nCells(), sumOp<label>())) + " cells, ";
    return cells + (direct_ ? std::string("direct solve by sine transforms") : equation_->description());
}

}  // namespace him
