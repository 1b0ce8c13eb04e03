// SPDX-License-Identifier: GPL-3.0-or-later
#include "gas/gasFlow.H"

#include "foamPoissonMesh/conversions.H"
#include "settings/checkedDictionary.H"

#include "extrapolatedCalculatedFvPatchFields.H"
#include "fixedFluxPressureFvPatchScalarField.H"
#include "fvc.H"
#include "fvm.H"
#include "zeroGradientFvPatchFields.H"

namespace him {

using namespace Foam;

namespace {

IOobject resultIO(const word& name, const fvMesh& mesh, IOobject::writeOption write)
{
    return IOobject(name, mesh.time().timeName(), mesh, IOobject::NO_READ, write);
}

IOobject givenIO(const word& name, const fvMesh& mesh)
{
    return IOobject(name, mesh.time().timeName(), mesh, IOobject::MUST_READ, IOobject::AUTO_WRITE);
}

/// Values across cuts and cyclic patches: decomposePar writes those of the own cells where it cuts through a cyclic patch.
template <class Type> void updateCoupledPatches(GeometricField<Type, fvPatchField, volMesh>& field)
{
    for (auto& patch : field.boundaryFieldRef()) {
        if (patch.coupled()) {
            patch.initEvaluate(Pstream::defaultCommsType);
        }
    }
    for (auto& patch : field.boundaryFieldRef()) {
        if (patch.coupled()) {
            patch.evaluate(Pstream::defaultCommsType);
        }
    }
}

/// Share of what passes the patches by which inflow and outflow may differ where no patch gives the pressure.
constexpr double mostUnbalanced = 1e-4;
/// Walls let as much pass, as a share of the volume.
constexpr double roundOff = 1e-12;

const dimensionSet dimImpulsePerVolume = dimDensity * dimVelocity;

}  // namespace

gasFlow::gasFlow(const fvMesh& mesh, const GasSettings& settings, const pimpleControls& controls, bool turbulent)
    : mesh_(mesh),
      settings_(settings),
      controls_(controls),
      referenceCell_(controls.referenceCellHere(mesh)),
      rho_("density", dimDensity, settings.density),
      nu_("nu", dimViscosity, settings.viscosity / settings.density),
      alpha_(resultIO("voidFraction", mesh, IOobject::AUTO_WRITE), mesh, dimensionedScalar("one", dimless, 1),
             zeroGradientFvPatchScalarField::typeName),
      U_(givenIO("U", mesh), mesh),
      p_(givenIO("p", mesh), mesh),
      phi_(IOobject("phi", mesh.time().timeName(), mesh, IOobject::READ_IF_PRESENT, IOobject::AUTO_WRITE),
           fvc::flux(U_)),
      alphaf_(resultIO("voidFractionf", mesh, IOobject::NO_WRITE), mesh, dimensionedScalar("one", dimless, 1)),
      alphaPhi_("alphaPhi", alphaf_ * phi_),
      pressureFlux_(resultIO("pressureFlux", mesh, IOobject::NO_WRITE), mesh,
                    dimensionedScalar(dimPressure * dimLength, Zero)),
      reconstruct_(mesh),
      K_(resultIO("dragPerGasMass", mesh, IOobject::NO_WRITE), mesh, dimensionedScalar(inv(dimTime), Zero),
         zeroGradientFvPatchScalarField::typeName),
      S_(resultIO("dragMomentum", mesh, IOobject::NO_WRITE), mesh, dimensionedVector(dimAcceleration, Zero),
         extrapolatedCalculatedFvPatchVectorField::typeName),
      continued_(
          IOobject("phi", mesh.time().timeName(), mesh, IOobject::MUST_READ).typeHeaderOk<surfaceScalarField>(true))
{
    mesh_.setFluxRequired(p_.name());
    updateCoupledPatches(U_);
    updateCoupledPatches(p_);
    if (!continued_) {
        phi_ = fvc::flux(U_);
        alphaPhi_ = alphaf_ * phi_;
    }
    if (turbulent) {
        turbulence_ = std::make_unique<gasTurbulence>(alpha_, U_, alphaPhi_, phi_, nu_.value());
    }
    result_.velocity.setZero(mesh_.nCells(), 3);
    result_.pressureForce.setZero(mesh_.nCells(), 3);
    if (settings_.needsGasMotion()) {
        result_.acceleration.setZero(mesh_.nCells(), 3);
        result_.vorticity.setZero(mesh_.nCells(), 3);
    }
    const volVectorField gradient(reconstruct_(fvc::snGrad(p_) * mesh_.magSf()));
    forAll(U_, cell)
    {
        result_.velocity.row(cell) = toEigen(U_[cell]).transpose().array();
        result_.pressureForce.row(cell) = -toEigen(gradient[cell]).transpose().array();
    }
}

void gasFlow::setVoidFraction(const Scalars& voidFraction)
{
    std::copy(voidFraction.begin(), voidFraction.end(), alpha_.primitiveFieldRef().begin());
    alpha_.correctBoundaryConditions();
    alphaf_ = fvc::interpolate(alpha_, "interpolate(voidFraction)");
}

void gasFlow::setDrag(const GasSources& sources, double deltaT)
{
    forAll(K_, cell)
    {
        K_[cell] = sources.drag[cell] / settings_.density;
        S_[cell] = toFoam(((sources.dragMomentum.row(cell) - sources.owed.row(cell) / deltaT) / settings_.density)
                              .matrix()
                              .transpose());
    }
    K_.correctBoundaryConditions();
    S_.correctBoundaryConditions();
}

void gasFlow::solve(const GasSources& sources)
{
    const double deltaT = mesh_.time().deltaTValue();

    // Not storeOldTimes(), which keeps nothing the first time: the void fraction of the step before would be that of this one.
    alpha_.oldTime();
    U_.oldTime();
    phi_.oldTime();
    setVoidFraction(sources.voidFraction);
    setDrag(sources, deltaT);
    for (long iteration = 0; iteration < controls_.outerCorrectors; ++iteration) {
        alphaPhi_ = alphaf_ * phi_;
        const volScalarField alphaNu("alphaNu", turbulence_ ? alpha_ * turbulence_->nuEff() : alpha_ * nu_);
        fvVectorMatrix UEqn(fvm::ddt(alpha_, U_) + fvm::div(alphaPhi_, U_, "div(alphaPhi,U)")
                            - fvm::Sp(fvc::ddt(alpha_) + fvc::div(alphaPhi_), U_)
                            - fvm::laplacian(alphaNu, U_, "laplacian(alphaNu,U)")
                            - fvc::div(alphaNu * dev2(T(fvc::grad(U_))), "div(alphaNu*dev2(T(grad(U))))"));
        const volScalarField A(UEqn.A());
        const bool last = iteration == controls_.outerCorrectors - 1;
        for (long corrector = 0; corrector < controls_.correctors; ++corrector) {
            correctPressure(A, UEqn.H(), last && corrector == controls_.correctors - 1);
        }
        if (last) {
            collectResult(UEqn, deltaT);
        }
    }
    if (p_.needReference()) {
        checkBalance();
    }
    if (turbulence_) {
        alphaPhi_ = alphaf_ * phi_;
        turbulence_->correct();
    }
}

void gasFlow::checkBalance() const
{
    double in = 0, all = 0;
    forAll(phi_.boundaryField(), patch)
    {
        if (!phi_.boundaryField()[patch].coupled()) {
            const scalarField flow(alphaf_.boundaryField()[patch] * phi_.boundaryField()[patch]);
            in -= sum(flow);
            all += sum(mag(flow));
        }
    }
    reduce(in, sumOp<scalar>());
    reduce(all, sumOp<scalar>());
    if (std::abs(in) > mostUnbalanced * all
        && std::abs(in) * mesh_.time().deltaTValue() > roundOff * gSum(mesh_.V().field())) {
        throw std::runtime_error(
            "no patch gives the pressure of the gas, but " + shown(in)
            + " m3/s more enter than leave, for which there is no room. Give one patch, an outlet, a fixedValue "
              "in p");
    }
}

void gasFlow::correctPressure(const volScalarField& A, const volVectorField& H, bool last)
{
    const surfaceScalarField Kf(fvc::interpolate(K_, "interpolate(drag)"));
    const surfaceScalarField inverse("inverseAK", 1 / (fvc::interpolate(A, "interpolate(A)") + Kf));
    const surfaceScalarField Sf(fvc::flux(S_));
    // The flux carries its own memory of the step before; interpolated cell velocities would smear it.
    surfaceScalarField memory((fvc::interpolate(alpha_.oldTime(), "interpolate(voidFraction)") * phi_.oldTime()
                               - fvc::flux(alpha_.oldTime() * U_.oldTime()))
                              / mesh_.time().deltaT());
    for (auto& patch : memory.boundaryFieldRef()) {
        if (!patch.coupled()) {
            patch = Zero;
        }
    }
    surfaceScalarField phiH("phiH", (fvc::flux(H) + memory + Sf) * inverse);
    surfaceScalarField share("share", alphaf_ / rho_);
    if (settings_.pressure == PressureModel::modelB) {
        share = 1 / rho_;
    }
    const surfaceScalarField rAf("rAf", share * inverse);

    auto& pressure = p_.boundaryFieldRef();
    forAll(pressure, patch)
    {
        const fvsPatchScalarField& inflow = phiH.boundaryField()[patch];
        const scalarField given(U_.boundaryField()[patch] & mesh_.Sf().boundaryField()[patch]);
        if (isA<fixedFluxPressureFvPatchScalarField>(pressure[patch])) {
            refCast<fixedFluxPressureFvPatchScalarField>(pressure[patch])
                .updateSnGrad((inflow - given) / (mesh_.magSf().boundaryField()[patch] * rAf.boundaryField()[patch]));
        }
    }

    for (long repeat = 0; repeat <= controls_.nonOrthogonalCorrectors; ++repeat) {
        const bool lastRepeat = repeat == controls_.nonOrthogonalCorrectors;
        fvScalarMatrix pEqn(fvm::laplacian(alphaf_ * rAf, p_, "laplacian(rAf,p)")
                            == fvc::ddt(alpha_) + fvc::div(alphaf_ * phiH));
        // One cell of all ranks: where no patch gives the pressure, a second one would be a source of gas.
        pEqn.setReference(referenceCell_, controls_.referenceValue);
        pEqn.solve(mesh_.solver(p_.select(last && lastRepeat)));
        if (lastRepeat) {
            const surfaceScalarField pressureFlow(pEqn.flux() / alphaf_);
            phi_ = phiH - pressureFlow;
            pressureFlux_ = pressureFlow / rAf;
        }
    }
    const surfaceScalarField balance(Sf - Kf * phi_ - share * pressureFlux_);
    U_ = (H + K_ * reconstruct_(phi_) + reconstruct_(balance)) / (A + K_);
    U_.correctBoundaryConditions();
}

void gasFlow::collectResult(const fvVectorMatrix& UEqn, double deltaT)
{
    const volVectorField gradient(reconstruct_(pressureFlux_));
    // The equation's left side without the part that keeps it from creating velocity where the mass does not balance: change,
    // convection and friction. What flows between cells cancels; the boundary's part is not given to particles.
    const volVectorField moved((UEqn & U_) + volVectorField(U_ * (fvc::ddt(alpha_) + fvc::div(alphaPhi_))));
    const scalarField& volumes = mesh_.V().field();
    // Not the sum of the reconstructed gradients: where faces stand askew it is not the pressure on the boundary.
    vector pressed = Zero;
    for (const fvPatchScalarField& patch : p_.boundaryField()) {
        if (!patch.coupled()) {
            pressed += sum(patch * patch.patch().Sf());
        }
    }
    reduce(pressed, sumOp<vector>());
    const vector given = -deltaT * (rho_.value() * gSum(vectorField(moved.primitiveField() * volumes)) + pressed);
    result_.given = toEigen(given);
    if (settings_.needsGasMotion()) {
        const volVectorField acceleration(fvc::ddt(U_) + (U_ & fvc::grad(U_)));
        const volVectorField vorticity(fvc::curl(U_));
        result_.acceleration.resize(mesh_.nCells(), 3);
        result_.vorticity.resize(mesh_.nCells(), 3);
        forAll(U_, cell)
        {
            result_.acceleration.row(cell) = toEigen(acceleration[cell]).transpose().array();
            result_.vorticity.row(cell) = toEigen(vorticity[cell]).transpose().array();
        }
    }
    forAll(U_, cell)
    {
        result_.velocity.row(cell) = toEigen(U_[cell]).transpose().array();
        result_.pressureForce.row(cell) = -toEigen(gradient[cell]).transpose().array();
    }
}

double gasFlow::courantNumber() const
{
    const scalarField sums(fvc::surfaceSum(mag(phi_))().primitiveField() / mesh_.V().field());
    return 0.5 * gMax(sums) * mesh_.time().deltaTValue();
}

Vector3 gasFlow::momentum() const
{
    return toEigen(rho_.value() * gSum(vectorField(alpha_.primitiveField() * U_.primitiveField() * mesh_.V().field())));
}

}  // namespace him
