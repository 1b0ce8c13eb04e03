// SPDX-License-Identifier: GPL-3.0-or-later
#include "gas/pimpleControls.H"

#include "settings/checkedDictionary.H"

#include "PstreamReduceOps.H"

namespace him {

pimpleControls pimpleControls::read(const Foam::fileName& casePath, Complaints& complaints)
{
    pimpleControls controls;
    const char* file = "system/fvSolution";
    if (!checkedDictionary::exists(casePath, file)) {
        return controls;
    }
    checkedDictionary solution(casePath, file, complaints);
    checkedDictionary entries = solution.section("PIMPLE", true);
    controls.outerCorrectors = entries.positiveInteger("nOuterCorrectors", controls.outerCorrectors);
    controls.correctors = entries.positiveInteger("nCorrectors", controls.correctors);
    controls.nonOrthogonalCorrectors =
        entries.nonNegativeInteger("nNonOrthogonalCorrectors", controls.nonOrthogonalCorrectors);
    controls.referenceCell = entries.nonNegativeInteger("pRefCell", controls.referenceCell);
    controls.referenceValue = entries.number("pRefValue", controls.referenceValue);
    entries.refuseUnknownEntries();
    return controls;
}

Foam::label pimpleControls::referenceCellHere(const Foam::polyMesh& mesh) const
{
    const Foam::label rank = mesh.nCells() > 0 ? Foam::Pstream::myProcNo() : Foam::Pstream::nProcs();
    const bool here = Foam::returnReduce(rank, Foam::minOp<Foam::label>()) == Foam::Pstream::myProcNo();
    return here ? static_cast<Foam::label>(referenceCell) : -1;
}

}  // namespace him
