// SPDX-License-Identifier: GPL-3.0-or-later
// write_packing <dilute|bed|layer> <side in diameters> <like|random> [seed] [diameter m] [charge C]
// One of the standard scenes as comma-separated values on the standard output: x,y,z,q,radius, from the origin of the cube.
#include "tests/support/packings.hpp"

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

namespace {

int usage(const char* program)
{
    std::fprintf(
        stderr,
        "usage: %s <dilute|bed|layer> <side in diameters, 6 or more> <like|random> [seed] [diameter m] [charge C]\n",
        program);
    return 1;
}

}  // namespace

int main(int argc, char* argv[])
{
    const std::string scene = argc > 1 ? argv[1] : "";
    const std::string signs = argc > 3 ? argv[3] : "";
    const double length = argc > 2 ? std::atof(argv[2]) : 0;
    const double diameter = argc > 5 ? std::atof(argv[5]) : 1;
    const double charge = argc > 6 ? std::atof(argv[6]) : 1;
    if ((scene != "dilute" && scene != "bed" && scene != "layer") || (signs != "like" && signs != "random")
        || !(length >= 6) || !(diameter > 0) || argc > 7) {
        return usage(argv[0]);
    }
    try {
        const him::Packing packing =
            him::makePacking(scene == "dilute" ? him::Scene::dilute
                             : scene == "bed"  ? him::Scene::bed
                                               : him::Scene::layer,
                             length, signs == "like" ? him::Signs::like : him::Signs::random,
                             argc > 4 ? static_cast<std::uint32_t>(std::atol(argv[4])) : 1, diameter, charge);
        std::puts("x,y,z,q,radius");
        for (him::Index row = 0; row < packing.charge.size(); ++row) {
            std::printf("%.17g,%.17g,%.17g,%.17g,%.17g\n", packing.position(row, 0), packing.position(row, 1),
                        packing.position(row, 2), packing.charge[row], 0.5 * diameter);
        }
    } catch (const std::exception& failure) {
        std::fprintf(stderr, "%s\n", failure.what());
        return 1;
    }
    return 0;
}
