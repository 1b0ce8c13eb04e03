// SPDX-License-Identifier: GPL-3.0-or-later
#include "foamPoissonMesh/insulatingWallFvPatchScalarField.H"

#include "electrostatics/constants.hpp"

#include "addToRunTimeSelectionTable.H"
#include "fvPatchFieldMapper.H"
#include "volFields.H"

namespace Foam {

makePatchTypeField(fvPatchScalarField, insulatingWallFvPatchScalarField);

insulatingWallFvPatchScalarField::insulatingWallFvPatchScalarField(const fvPatch& p,
                                                                   const DimensionedField<scalar, volMesh>& iF)
    : mixedFvPatchScalarField(p, iF)
{
    refValue() = 0;
    refGrad() = 0;
    valueFraction() = 1;
}

insulatingWallFvPatchScalarField::insulatingWallFvPatchScalarField(const fvPatch& p,
                                                                   const DimensionedField<scalar, volMesh>& iF,
                                                                   const dictionary& dict)
    : mixedFvPatchScalarField(p, iF),
      thickness_(dict.getCheck<scalar>("thickness", scalarMinMax::ge(VSMALL))),
      relativePermittivity_(dict.getCheck<scalar>("relativePermittivity", scalarMinMax::ge(VSMALL))),
      outerPotential_(dict.getOrDefault<scalar>("outerPotential", 0))
{
    refGrad() = 0;
    setCharge(scalarField(p.size(), Zero), scalarField(p.size(), him::epsilon0));
    fvPatchScalarField::operator=(patchInternalField());
}

insulatingWallFvPatchScalarField::insulatingWallFvPatchScalarField(const insulatingWallFvPatchScalarField& other,
                                                                   const fvPatch& p,
                                                                   const DimensionedField<scalar, volMesh>& iF,
                                                                   const fvPatchFieldMapper& mapper)
    : mixedFvPatchScalarField(other, p, iF, mapper),
      thickness_(other.thickness_),
      relativePermittivity_(other.relativePermittivity_),
      outerPotential_(other.outerPotential_)
{
}

insulatingWallFvPatchScalarField::insulatingWallFvPatchScalarField(const insulatingWallFvPatchScalarField& other,
                                                                   const DimensionedField<scalar, volMesh>& iF)
    : mixedFvPatchScalarField(other, iF),
      thickness_(other.thickness_),
      relativePermittivity_(other.relativePermittivity_),
      outerPotential_(other.outerPotential_)
{
}

void insulatingWallFvPatchScalarField::setCharge(const scalarField& surfaceCharge, const scalarField& permittivity)
{
    const scalar plate = relativePermittivity_ * him::epsilon0 / thickness_;
    valueFraction() = plate / (permittivity * patch().deltaCoeffs() + plate);
    refValue() = outerPotential_ + surfaceCharge / plate;
}

void insulatingWallFvPatchScalarField::write(Ostream& os) const
{
    fvPatchScalarField::write(os);
    os.writeEntry("thickness", thickness_);
    os.writeEntry("relativePermittivity", relativePermittivity_);
    os.writeEntry("outerPotential", outerPotential_);
    writeEntry("value", os);
}

}  // namespace Foam
