// SPDX-License-Identifier: GPL-3.0-or-later
// The models of OpenFOAM that a gas with a void fraction can have, by the names of constant/turbulenceProperties. They are
// OpenFOAM's own templates; its library has them only for a viscosity from constant/transportProperties.
#include "gas/gasTransport.H"

// Before Stokes.H, which the end of it includes.
#include "laminarModel.H"

#include "LESModel.H"
#include "PhaseIncompressibleTurbulenceModel.H"
#include "RASModel.H"
#include "Stokes.H"
#include "addToRunTimeSelectionTable.H"
#include "makeTurbulenceModel.H"

#include "RNGkEpsilon.H"
#include "kEpsilon.H"
#include "kOmegaSST.H"
#include "realizableKE.H"

#include "Smagorinsky.H"
#include "WALE.H"
#include "dynamicKEqn.H"
#include "kEqn.H"

makeTurbulenceModelTypes(volScalarField, geometricOneField, incompressibleTurbulenceModel,
                         PhaseIncompressibleTurbulenceModel, gasTransport);
makeBaseTurbulenceModel(volScalarField, geometricOneField, incompressibleTurbulenceModel,
                        PhaseIncompressibleTurbulenceModel, gasTransport);

makeTemplatedTurbulenceModel(gasTransportPhaseIncompressibleTurbulenceModel, laminar, Stokes);

makeTemplatedTurbulenceModel(gasTransportPhaseIncompressibleTurbulenceModel, RAS, kEpsilon);
makeTemplatedTurbulenceModel(gasTransportPhaseIncompressibleTurbulenceModel, RAS, kOmegaSST);
makeTemplatedTurbulenceModel(gasTransportPhaseIncompressibleTurbulenceModel, RAS, realizableKE);
makeTemplatedTurbulenceModel(gasTransportPhaseIncompressibleTurbulenceModel, RAS, RNGkEpsilon);

makeTemplatedTurbulenceModel(gasTransportPhaseIncompressibleTurbulenceModel, LES, Smagorinsky);
makeTemplatedTurbulenceModel(gasTransportPhaseIncompressibleTurbulenceModel, LES, WALE);
makeTemplatedTurbulenceModel(gasTransportPhaseIncompressibleTurbulenceModel, LES, kEqn);
makeTemplatedTurbulenceModel(gasTransportPhaseIncompressibleTurbulenceModel, LES, dynamicKEqn);
