// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/liggghts/efield_him_options.hpp"

#include "dem_coupling/field_method.hpp"
#include "dem_coupling/liggghts/word_reader.hpp"
#include "electrostatics/constants.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

namespace him {

namespace {

constexpr const char* knownKeywords = "method, cutoff, images, without_image, every, external, relative_permittivity, "
                                      "wall_contact_field, limit_field_force, "
                                      "field_force_limit_factor";

std::string namesOf(const std::vector<DemWall>& walls)
{
    std::string names;
    for (const DemWall& wall : walls) {
        names += (names.empty() ? "" : ", ") + wall.name;
    }
    return names.empty() ? "none" : names;
}

std::string methodsWithMesh(bool mesh)
{
    std::string names;
    for (const std::string& name : FieldMethod::names()) {
        if (FieldMethod::needsMesh(name) == mesh) {
            names += (names.empty() ? "" : ", ") + name;
        }
    }
    return names;
}

void readEvery(WordReader& words, EfieldHimOptions& options, Complaints& complaints)
{
    const double every = words.positive("every", "[DEM steps]");
    if (every > 0 && (every != std::floor(every) || every > 1e9)) {
        complaints.add("every", "a whole number of DEM steps up to 1e9 is expected");
    } else if (every > 0) {
        options.every = static_cast<long>(every);
    }
}

void checkMethod(const EfieldHimOptions& options, const std::set<std::string>& given, Complaints& complaints)
{
    const std::string& method = options.field.method;
    const std::vector<std::string>& all = FieldMethod::names();
    if (!given.count("method")) {
        complaints.add("method", "the keyword is missing; known methods: " + methodsWithMesh(false));
    } else if (std::find(all.begin(), all.end(), method) == all.end()) {
        complaints.add("method", "unknown field method '" + method + "'; known: " + methodsWithMesh(false));
    } else if (FieldMethod::needsMesh(method)) {
        complaints.add("method", method + " solves Poisson's equation on a mesh, and liggghtsHim has none. Use one of "
                                     + methodsWithMesh(false) + ", or run the scene with himFoam");
    } else if (FieldMethod::needsCutoff(method) && !given.count("cutoff")) {
        complaints.add("cutoff", method + " needs it: the distance [m] up to which pairs act on each other");
    }
    for (const char* keyword : {"images", "without_image"}) {
        if (given.count(keyword) && !method.empty() && method != "pairwiseSum") {
            complaints.add(keyword, "only pairwiseSum mirrors charges in walls; method is '" + method + "'");
        }
    }
    if (given.count("without_image") && !options.field.pairwiseSum.images) {
        complaints.add("without_image", "nothing is mirrored without 'images yes'");
    }
}

}  // namespace

EfieldHimOptions readEfieldHimOptions(const std::vector<std::string>& words)
{
    EfieldHimOptions options;
    options.field.permittivity = epsilon0;
    Complaints complaints;
    WordReader reader(words, complaints);
    std::set<std::string> given;
    while (!reader.done()) {
        const std::string keyword = reader.word("");
        if (!given.insert(keyword).second && keyword != "without_image") {
            complaints.add(keyword, "given twice");
        }
        if (keyword == "method") {
            options.field.method = reader.word(keyword);
        } else if (keyword == "cutoff") {
            const double cutoff = reader.positive(keyword, "[m]");
            options.field.nearCutoff = cutoff;
            options.field.pairwiseSum.truncation = cutoff;
        } else if (keyword == "images") {
            options.field.pairwiseSum.images = reader.oneOf(keyword, {"no", "yes"}) == 1;
        } else if (keyword == "without_image") {
            options.withoutImage.push_back(reader.word(keyword));
        } else if (keyword == "every") {
            readEvery(reader, options, complaints);
        } else if (keyword == "external") {
            for (int axis = 0; axis < 3; ++axis) {
                options.field.externalField[axis] = reader.number("external <Ex> <Ey> <Ez>");
            }
        } else if (keyword == "relative_permittivity") {
            options.field.permittivity = epsilon0 * reader.positive(keyword, "[-]");
        } else if (keyword == "wall_contact_field") {
            options.wallContactField =
                reader.oneOf(keyword, {"total", "self"}) == 1 ? WallContactField::self : WallContactField::total;
        } else if (!readLimiter(keyword, reader, options.limiter, complaints)) {
            throw std::invalid_argument("unknown keyword '" + keyword + "'; known: " + knownKeywords);
        }
    }
    checkMethod(options, given, complaints);
    if (!complaints.none()) {
        throw std::invalid_argument(complaints.text());
    }
    return options;
}

void findImageWalls(EfieldHimOptions& options, const std::vector<DemWall>& walls, Complaints& complaints)
{
    PairwiseSumSettings& sum = options.field.pairwiseSum;
    sum.imageWalls.clear();
    if (!sum.images) {
        return;
    }
    const std::vector<std::string>& without = options.withoutImage;
    for (const std::string& name : without) {
        if (std::none_of(walls.begin(), walls.end(), [&](const DemWall& wall) { return wall.name == name; })) {
            complaints.add("without_image " + name, "the script has no such wall; it has: " + namesOf(walls));
        }
    }
    for (const DemWall& wall : walls) {
        if (std::find(without.begin(), without.end(), wall.name) != without.end()) {
            continue;
        }
        if (wall.primitive) {
            sum.imageWalls.push_back(wall.image);
        } else {
            complaints.add("images yes",
                           "wall " + wall.name
                               + " is a mesh, and the pair sum mirrors charges in planes and cylinders only. Use "
                                 "a primitive wall, or write without_image "
                               + wall.name + ", or use p3m in himFoam");
        }
    }
    if (sum.imageWalls.empty() && complaints.none()) {
        complaints.add("images yes", "the script has no primitive granular wall to mirror charges in");
    }
}

}  // namespace him
