// SPDX-License-Identifier: GPL-3.0-or-later
#include "gas/gasTurbulence.H"

#include "gas/gasTransport.H"
#include "settings/checkedDictionary.H"

#include "LESModel.H"
#include "PhaseIncompressibleTurbulenceModel.H"
#include "RASModel.H"
#include "fvMatrices.H"
#include "surfaceFields.H"

namespace him {

namespace {

using Model = Foam::PhaseIncompressibleTurbulenceModel<Foam::gasTransport>;

template <class Kind> std::vector<std::string> knownModels()
{
    std::vector<std::string> names;
    for (const Foam::word& name : Kind::dictionaryConstructorTablePtr_->sortedToc()) {
        names.push_back(name);
    }
    return names;
}

}  // namespace

struct gasTurbulence::parts {
    Foam::gasTransport transport;
    Foam::autoPtr<Model> model;
};

std::string gasTurbulence::modelOf(const Foam::fileName& casePath, Complaints& complaints)
{
    if (!checkedDictionary::exists(casePath, turbulenceFile)) {
        return "";
    }
    checkedDictionary entries(casePath, turbulenceFile, complaints);
    const std::string kind = entries.oneOf("simulationType", {"laminar", "RAS", "LES"});
    if (kind == "RAS") {
        return entries.section("RAS").oneOf("RASModel", knownModels<Foam::RASModel<Model>>());
    }
    if (kind == "laminar" && entries.has("laminar")) {
        checkedDictionary laminar = entries.section("laminar");
        laminar.oneOf(laminar.has("model") ? "model" : "laminarModel", {"Stokes"}, "Stokes");
    }
    return kind == "LES" ? entries.section("LES").oneOf("LESModel", knownModels<Foam::LESModel<Model>>()) : "";
}

gasTurbulence::gasTurbulence(const Foam::volScalarField& alpha, const Foam::volVectorField& U,
                             const Foam::surfaceScalarField& alphaPhi, const Foam::surfaceScalarField& phi, double nu)
    : parts_(new parts{Foam::gasTransport(alpha.mesh(), nu), nullptr})
{
    parts_->model = Model::New(alpha, U, alphaPhi, phi, parts_->transport);
    parts_->model->validate();
}

gasTurbulence::~gasTurbulence() = default;

Foam::tmp<Foam::volScalarField> gasTurbulence::nuEff() const
{
    return parts_->model->nuEff();
}

void gasTurbulence::correct()
{
    parts_->model->correct();
}

}  // namespace him
