// SPDX-License-Identifier: GPL-3.0-or-later
#include "checks/caseChecks.H"

#include "settings/checkedDictionary.H"

namespace him {

void checkPressureDrop(const statisticsChoices& statistics, const Foam::fvMesh* mesh, Complaints& complaints)
{
    if (!statistics.pressureDrop) {
        return;
    }
    const std::string where = "system/particleStatistics: pressureDrop";
    if (!mesh) {
        complaints.add(where, "the case has no gas (constant/gasProperties), so there is no pressure drop. Take the entry out.");
        return;
    }
    std::vector<std::string> known;
    for (const Foam::polyPatch& patch : mesh->boundaryMesh()) {
        known.push_back(patch.name());
    }
    for (const std::string& name : {statistics.pressureDrop->inlet, statistics.pressureDrop->outlet}) {
        if (!name.empty() && mesh->boundaryMesh().findPatchID(name) < 0) {
            complaints.add(where, "unknown patch `" + name + "`; known: " + joined(known) + ".");
        }
    }
}

}  // namespace him
