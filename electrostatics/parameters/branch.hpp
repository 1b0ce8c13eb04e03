// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace him {

/// Ways from measurements to Gamma and kappa_c (R section 2.2 and Fig. 3). `particleWallHistory` is ours: it takes the
/// whole charging curve of a reciprocating charger instead of one impact and a saturation charge.
enum class Branch {
    particleWall,
    particleWallSaturationOnly,
    particleWallWithoutSaturation,
    particleWallHistory,
    dissimilarPair,
    dissimilarPairSaturationOnly,
    dissimilarPairWithoutSaturation,
    similarPair,
    similarPairNearlyEqual
};

/// What a measurement knows: the questions of the flowchart.
struct KnownQuantities {
    bool atWall = true;             ///< particle-wall, else particle-particle
    bool similar = false;           ///< both particles of one material and size
    bool saturation = false;        ///< saturation charge of every particle
    bool chargeTransfer = false;    ///< charge moved by one contact
    bool chargeDifference = false;  ///< that of two similar particles before the contact, and not zero
    bool history = false;           ///< charge against the number of contacts
};

/// The branch for what is known. Throws std::invalid_argument that says what is missing when nothing can be found.
Branch chooseBranch(const KnownQuantities& known);

/// Name of a branch, as in the enumeration.
std::string nameOf(Branch branch);
/// Equations of R that the branch uses, like "Gamma by R17, kappa_c by R20".
std::string equationsOf(Branch branch);
/// All branches.
const std::vector<Branch>& allBranches();

}  // namespace him
