// SPDX-License-Identifier: GPL-3.0-or-later
#include "settings/statisticsChoices.H"

#include "settings/checkedDictionary.H"

#include <algorithm>
#include <cmath>

namespace him {

namespace {

constexpr const char* file = "system/particleStatistics";

/// Order of WalledBox::walls.
const std::vector<std::string> sides{"xMin", "xMax", "yMin", "yMax", "zMin", "zMax"};

/// The charge distribution reaches so far beyond the equilibrium charge.
constexpr double beyondEquilibrium = 1.2;

/// Of a profile or a distribution.
constexpr double mostBins = 1e6;

std::optional<double> optionalLength(checkedDictionary& entries, const std::string& entry)
{
    return entries.has(entry) ? std::optional<double>(entries.positive(entry, 1)) : std::nullopt;
}

void readCorner(checkedDictionary& entries, const std::string& entry, std::array<std::optional<double>, 3>& corner)
{
    if (entries.has(entry)) {
        const Vector3 point = entries.vector(entry, Vector3::Zero());
        for (int axis = 0; axis < 3; ++axis) {
            corner[static_cast<std::size_t>(axis)] = point[axis];
        }
    }
}

void readSides(checkedDictionary& entries, std::array<bool, 6>& walls)
{
    for (const std::string& name : entries.names("walls")) {
        const auto side = std::find(sides.begin(), sides.end(), name);
        if (side == sides.end()) {
            entries.complain("walls", "unknown side `" + name + "`; known: " + joined(sides) + ".");
            continue;
        }
        bool& wall = walls[static_cast<std::size_t>(side - sides.begin())];
        if (wall) {
            entries.complain("walls", "the side " + name + " is named twice.");
        }
        wall = true;
    }
}

/// Entries that a region may have and that the top of the file may give for all.
void readCommon(checkedDictionary& entries, regionChoice& region)
{
    const auto length = [&](const std::string& entry, std::optional<double>& value) {
        const std::optional<double> found = optionalLength(entries, entry);
        value = found ? found : value;
    };
    length("layerThickness", region.layerThickness);
    length("profileWidth", region.profileWidth);
    length("profileDepth", region.profileDepth);
    region.layers = entries.positiveInteger("layers", region.layers);
    region.chargeBins = entries.positiveInteger("chargeBins", region.chargeBins);
    if (region.chargeBins > mostBins) {
        entries.complain("chargeBins", "found " + std::to_string(region.chargeBins) + "; allowed are " + shown(mostBins)
                                           + " at most.");
    }
    if (entries.has("chargeRange")) {
        const std::vector<double> range = entries.numbers("chargeRange");
        if (range.size() == 2 && range[0] < range[1]) {
            region.chargeRange = {range[0], range[1]};
        } else {
            entries.complain("chargeRange",
                             "found `" + entries.written("chargeRange")
                                 + "`, but two charges [C], the lower one first, are expected, like (-1e-12 1e-12).");
        }
    }
}

regionChoice readRegion(const std::string& name, checkedDictionary entries, const regionChoice& common)
{
    regionChoice region = common;
    region.name = name;
    readCorner(entries, "lower", region.lower);
    readCorner(entries, "upper", region.upper);
    readSides(entries, region.walls);
    readCommon(entries, region);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (region.lower[axis] && region.upper[axis] && !(*region.lower[axis] < *region.upper[axis])) {
            entries.complain("upper", "along " + std::string(1, "xyz"[axis]) + " the region ends at "
                                          + shown(*region.upper[axis]) + " m, not above its lower corner, "
                                          + shown(*region.lower[axis]) + " m.");
        }
    }
    const bool walled = std::any_of(region.walls.begin(), region.walls.end(), [](bool wall) { return wall; });
    for (const char* entry : {"layers", "profileWidth", "profileDepth"}) {
        if (!walled && entries.has(entry)) {
            entries.complain(
                entry, "is about the distance from walls, but no side of the region is named as one. Write walls (xMin "
                       "xMax), for example.");
        }
    }
    entries.refuseUnknownEntries();
    return region;
}

/// Half the distance between the nearest two walls that face each other, or the whole reach where one has none.
double depthOf(const WalledBox& place)
{
    double depth = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        const auto n = static_cast<std::size_t>(2 * axis);
        const int walls = place.walls[n] + place.walls[n + 1];
        if (walls > 0) {
            depth = std::min(depth, place.box.size()[axis] / walls);
        }
    }
    return depth;
}

}  // namespace

statisticsChoices readStatisticsChoices(const Foam::fileName& casePath, Complaints& complaints)
{
    statisticsChoices choices;
    if (!checkedDictionary::exists(casePath, file)) {
        return choices;
    }
    checkedDictionary entries(casePath, file, complaints);
    choices.active = entries.readable();
    choices.sampleInterval = entries.positiveInteger("sampleInterval", 1);
    choices.chargingSince = entries.number("chargingSince", 0);
    if (entries.has("pressureDrop")) {
        checkedDictionary drop = entries.section("pressureDrop");
        choices.pressureDrop = pressureDropChoice{};
        for (const auto& [entry, patch] : {std::pair<const char*, std::string*>{"inlet", &choices.pressureDrop->inlet},
                                           {"outlet", &choices.pressureDrop->outlet}}) {
            *patch = drop.written(entry);
            if (patch->empty() && drop.readable()) {
                drop.complain(entry, "the entry is missing. Name a patch of the gas's mesh.");
            }
        }
        choices.pressureDrop->emptyColumn = drop.number("emptyColumn", 0);
        drop.refuseUnknownEntries();
    }
    regionChoice common;
    readCommon(entries, common);
    checkedDictionary regions = entries.section("regions");
    for (const Foam::word& name : regions.contents().toc()) {
        choices.regions.push_back(readRegion(name, regions.section(name), common));
    }
    if (regions.readable() && choices.regions.empty()) {
        entries.complain("regions", "no region is named. Write `bed {}` for the whole DEM box.");
    }
    entries.refuseUnknownEntries();
    return choices;
}

std::vector<StatisticsRegion> completeRegions(const statisticsChoices& choices, const DemPort& dem,
                                              MPI_Comm communicator, Complaints& complaints)
{
    std::vector<StatisticsRegion> regions;
    if (!choices.active) {
        return regions;
    }
    DemParticles particles;
    dem.particles(particles);
    const ParticleScale scale = scaleOf(particles, communicator);
    double equilibrium = 0;
    for (const WallEquilibrium& one : dem.equilibria()) {
        equilibrium = std::max(equilibrium, std::fabs(one.charge));
    }
    const Box demBox = dem.box();
    for (const regionChoice& choice : choices.regions) {
        const std::string where = std::string(file) + ": regions: " + choice.name;
        StatisticsRegion region;
        region.name = choice.name;
        region.place.walls = choice.walls;
        region.place.box = demBox;
        for (int axis = 0; axis < 3; ++axis) {
            const auto n = static_cast<std::size_t>(axis);
            region.place.box.lower[axis] = choice.lower[n].value_or(demBox.lower[axis]);
            region.place.box.upper[axis] = choice.upper[n].value_or(demBox.upper[axis]);
        }
        if (region.place.box.empty() || !region.place.box.overlaps(demBox)) {
            complaints.add(
                where,
                "the region lies outside the DEM box, which is where particles are. Check its corners (metres).");
            continue;
        }
        if (!choice.layerThickness && scale.particles == 0) {
            complaints.add(where + ": layerThickness",
                           "the entry is missing, and its default, the mean diameter, is that of no "
                           "particle: the scene starts without any.");
            continue;
        }
        region.layerThickness = choice.layerThickness.value_or(scale.meanDiameter);
        if (std::any_of(choice.walls.begin(), choice.walls.end(), [](bool wall) { return wall; })) {
            const double depth = choice.profileDepth.value_or(depthOf(region.place));
            region.layers = static_cast<int>(choice.layers);
            region.profileWidth = choice.profileWidth.value_or(0.5 * region.layerThickness);
            const double bins = std::ceil(depth / region.profileWidth * (1 - 1e-9));
            if (bins > mostBins) {
                complaints.add(where + ": profileWidth", "found " + shown(region.profileWidth) + " m, which makes "
                                                             + shown(bins) + " bins; allowed are " + shown(mostBins)
                                                             + ". Write a larger width.");
                continue;
            }
            region.profileBins = std::max(1, static_cast<int>(bins));
        }
        const double reach = beyondEquilibrium * (equilibrium > 0 ? equilibrium : scale.largestCharge);
        if (!choice.chargeRange && reach == 0) {
            regions.push_back(region);  // no charge and none to come: no distribution
            continue;
        }
        region.lowestCharge = choice.chargeRange ? choice.chargeRange->first : -reach;
        region.highestCharge = choice.chargeRange ? choice.chargeRange->second : reach;
        region.chargeBins = static_cast<int>(choice.chargeBins);
        regions.push_back(region);
    }
    return regions;
}

}  // namespace him
