// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/parameters/branch.hpp"

#include <stdexcept>

namespace him {

namespace {

struct Description {
    Branch branch;
    const char* name;
    const char* equations;
};

const Description descriptions[] = {
    {Branch::particleWall, "particleWall", "Gamma by R17, kappa_c by R20"},
    {Branch::particleWallSaturationOnly, "particleWallSaturationOnly", "Gamma by R17; kappa_c needs a charge transfer"},
    {Branch::particleWallWithoutSaturation, "particleWallWithoutSaturation",
     "Gamma kappa_c by R24; each by itself needs a saturation charge"},
    {Branch::particleWallHistory, "particleWallHistory",
     "Gamma by R17, kappa_c by R20, both from a fit to all readings"},
    {Branch::dissimilarPair, "dissimilarPair", "Gamma by R18, kappa_c by R21"},
    {Branch::dissimilarPairSaturationOnly, "dissimilarPairSaturationOnly",
     "Gamma by R18; kappa_c needs a charge transfer"},
    {Branch::dissimilarPairWithoutSaturation, "dissimilarPairWithoutSaturation",
     "Gamma kappa_c by R24; each by itself needs both saturation charges"},
    {Branch::similarPair, "similarPair", "Gamma is 0, kappa_c by R22"},
    {Branch::similarPairNearlyEqual, "similarPairNearlyEqual", "Gamma is 0, kappa_c by R23"},
};

const Description& descriptionOf(Branch branch)
{
    for (const Description& description : descriptions) {
        if (description.branch == branch) {
            return description;
        }
    }
    throw std::invalid_argument("no such branch");
}

Branch atWall(const KnownQuantities& known)
{
    if (known.history) {
        return Branch::particleWallHistory;
    }
    if (known.saturation) {
        return known.chargeTransfer ? Branch::particleWall : Branch::particleWallSaturationOnly;
    }
    if (known.chargeTransfer) {
        return Branch::particleWallWithoutSaturation;
    }
    throw std::invalid_argument("neither a saturation charge nor a charge transfer is known");
}

}  // namespace

Branch chooseBranch(const KnownQuantities& known)
{
    if (known.atWall) {
        return atWall(known);
    }
    if (known.similar) {
        return known.chargeTransfer && known.chargeDifference ? Branch::similarPair : Branch::similarPairNearlyEqual;
    }
    if (known.saturation) {
        return known.chargeTransfer ? Branch::dissimilarPair : Branch::dissimilarPairSaturationOnly;
    }
    if (known.chargeTransfer) {
        return Branch::dissimilarPairWithoutSaturation;
    }
    throw std::invalid_argument("neither the saturation charges of both particles nor a charge transfer is known");
}

std::string nameOf(Branch branch)
{
    return descriptionOf(branch).name;
}

std::string equationsOf(Branch branch)
{
    return descriptionOf(branch).equations;
}

const std::vector<Branch>& allBranches()
{
    static const std::vector<Branch> all = [] {
        std::vector<Branch> found;
        for (const Description& description : descriptions) {
            found.push_back(description.branch);
        }
        return found;
    }();
    return all;
}

}  // namespace him
