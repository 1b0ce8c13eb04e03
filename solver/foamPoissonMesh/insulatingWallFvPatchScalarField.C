// SPDX-License-Identifier: GPL-3.0-or-later
#include "foamPoissonMesh/insulatingWallFvPatchScalarField.H"

#include "electrostatics/constants.hpp"

#include "HashSet.H"
#include "OStringStream.H"
#include "addToRunTimeSelectionTable.H"
#include "fvPatchFieldMapper.H"
#include "volFields.H"

namespace Foam {

namespace {

/// A required number above zero; else an error that says what was found and what is allowed.
scalar positive(const dictionary& dict, const fvPatch& patch, const word& name)
{
    const entry* given = dict.findEntry(name, keyType::LITERAL);
    if (!given) {
        FatalIOErrorInFunction(dict)
            << patch.name() << ": " << name
            << ": the entry is missing. An insulatingWall needs `thickness` [m] and `relativePermittivity`"
            << exit(FatalIOError);
    }
    scalar value = 0;
    OStringStream found;
    if (given->isStream()) {
        const tokenList& tokens = given->stream();
        forAll(tokens, i)
        {
            found << (i > 0 ? " " : "") << tokens[i];
        }
        value = tokens.size() == 1 && tokens[0].isNumber() ? tokens[0].number() : 0;
    }
    if (!(value > 0)) {
        FatalIOErrorInFunction(dict) << patch.name() << ": " << name << ": found `" << found.str().c_str()
                                     << "`, but a number above zero is expected" << exit(FatalIOError);
    }
    return value;
}

}  // namespace

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
      thickness_(positive(dict, p, "thickness")),
      relativePermittivity_(positive(dict, p, "relativePermittivity")),
      outerPotential_(dict.getOrDefault<scalar>("outerPotential", 0))
{
    for (const word& name : dict.toc()) {
        if (!wordHashSet{"type", "patchType", "value", "thickness", "relativePermittivity", "outerPotential"}.found(
                name)) {
            FatalIOErrorInFunction(dict) << p.name() << ": unknown entry `" << name
                                         << "`; insulatingWall knows thickness, relativePermittivity and outerPotential"
                                         << exit(FatalIOError);
        }
    }
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
