// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/field_method.hpp"

#include "dem_coupling/field_methods/direct_truncation.hpp"
#include "dem_coupling/field_methods/him.hpp"
#include "dem_coupling/field_methods/him_cell.hpp"
#include "dem_coupling/field_methods/hybrid_particle_cell.hpp"
#include "dem_coupling/field_methods/p3m.hpp"
#include "dem_coupling/field_methods/pairwise_sum.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>

namespace him {

namespace {

struct Method {
    std::string name;
    bool needsMesh;
    bool needsCutoff;
    bool sumsAll;  ///< every charge acts on every other directly, so there can be no periodic copies
};

const std::vector<Method>& methods()
{
    static const std::vector<Method> list{
        {"pairwiseSum", false, false, true},      {"directTruncation", false, true, false},
        {"hybridParticleCell", true, true, true}, {"him", true, true, false},
        {"himCell", true, false, false},          {"p3m", true, false, false},
    };
    return list;
}

const Method* find(const std::string& name)
{
    const auto found =
        std::find_if(methods().begin(), methods().end(), [&](const Method& m) { return m.name == name; });
    return found == methods().end() ? nullptr : &*found;
}

std::string unknownName(const std::string& name)
{
    std::string known;
    for (const Method& method : methods()) {
        known += (known.empty() ? "" : ", ") + method.name;
    }
    return "unknown field method \"" + name + "\"; known: " + known;
}

const Method& get(const std::string& name)
{
    const Method* method = find(name);
    if (!method) {
        throw std::invalid_argument(unknownName(name));
    }
    return *method;
}

constexpr const char* file = "electrostaticProperties";

void checkCutoff(const FieldSettings& settings, const PoissonMesh* mesh, const Box& demBox,
                 const std::array<bool, 3>& periodic, Complaints& complaints)
{
    const std::string entry = std::string(file) + "." + settings.method + "Coeffs.nearCutoff";
    const double cutoff = settings.nearCutoff;
    std::ostringstream text;
    if (!(cutoff > 0)) {
        text << cutoff << " m is not a positive length";
        complaints.add(entry, text.str());
        return;
    }
    if (mesh) {
        const double diagonal = mesh->largestCellDiagonal();
        if (cutoff < diagonal * (1 - 1e-9)) {
            text << cutoff << " m is below the largest cell diagonal, " << diagonal
                 << " m. Pairs inside one cell would be missed. Use at least " << diagonal << ", or refine the mesh";
            complaints.add(entry, text.str());
        }
    }
    for (int axis = 0; axis < 3; ++axis) {
        if (periodic[static_cast<std::size_t>(axis)] && cutoff > demBox.size()[axis]) {
            std::ostringstream tooLong;
            tooLong << cutoff << " m is longer than the periodic DEM box in "
                    << "xyz"[axis] << ", " << demBox.size()[axis] << " m. Use at most that, or a larger box";
            complaints.add(entry, tooLong.str());
        }
    }
}

/// Fewer cells than this sample a cloud too coarsely (field errors of 8 % and more).
constexpr double fewestCloudCells = 1.75;

void checkP3m(const P3mSettings& settings, const Box& demBox, const std::array<bool, 3>& periodic,
              Complaints& complaints)
{
    const std::string entries = std::string(file) + ".p3mCoeffs.";
    std::ostringstream text;
    if (settings.cloudRadius <= 0 && !(settings.cloudCells >= fewestCloudCells)) {
        text << "a cloud radius of " << settings.cloudCells
             << " cells is too small: the mesh samples such a cloud too coarsely. Use at least " << fewestCloudCells
             << "; 2 is the default, 3 or 4 are more accurate";
        complaints.add(entries + "cloudCells", text.str());
    }
    if (settings.cloudExponent < 0 || settings.cloudExponent > 2) {
        complaints.add(entries + "cloudExponent", std::to_string(settings.cloudExponent)
                                                      + " is not known; known: 1, 2, and 0 to choose by the radius");
    }
    for (int axis = 0; axis < 3; ++axis) {
        if (periodic[static_cast<std::size_t>(axis)] && settings.cloudRadius > demBox.size()[axis]) {
            std::ostringstream tooLong;
            tooLong << settings.cloudRadius << " m is longer than the periodic DEM box in "
                    << "xyz"[axis] << ", " << demBox.size()[axis] << " m. Use at most that, or a larger box";
            complaints.add(entries + "cloudRadius", tooLong.str());
        }
    }
}

}  // namespace

const std::vector<std::string>& FieldMethod::names()
{
    static const std::vector<std::string> list = [] {
        std::vector<std::string> all;
        for (const Method& method : methods()) {
            all.push_back(method.name);
        }
        return all;
    }();
    return list;
}

bool FieldMethod::needsMesh(const std::string& name)
{
    return get(name).needsMesh;
}

bool FieldMethod::needsCutoff(const std::string& name)
{
    return get(name).needsCutoff;
}

bool FieldMethod::knowsPoints(const std::string& name)
{
    return get(name).name == "pairwiseSum" || name == "p3m";
}

std::string FieldMethod::noPointsText(const std::string& name)
{
    return "atContactPoint needs the field of the others where no particle's centre is, and " + name
           + " gives fields at centres only. pairwiseSum and p3m have it; with " + name
           + " use centre (S, the default)";
}

Complaints FieldMethod::check(const FieldSettings& settings, const PoissonMesh* mesh, const Box& demBox,
                              const std::array<bool, 3>& periodic)
{
    Complaints complaints;
    if (!(settings.permittivity > 0)) {
        std::ostringstream text;
        text << "a permittivity of " << settings.permittivity << " F/m is not positive";
        complaints.add(std::string(file) + ".relativePermittivity", text.str());
    }
    const std::string entry = std::string(file) + ".fieldMethod";
    const Method* method = find(settings.method);
    if (!method) {
        complaints.add(entry, unknownName(settings.method));
        return complaints;
    }
    if (method->needsMesh && !mesh) {
        complaints.add(entry, settings.method
                                  + " needs a mesh, and the case has none. Make one in constant/polyMesh, or use "
                                    "pairwiseSum or directTruncation");
    }
    for (int axis = 0; settings.nearField.interval > 0 && axis < 3; ++axis) {
        if (periodic[static_cast<std::size_t>(axis)] && settings.nearField.reach > demBox.size()[axis]) {
            std::ostringstream text;
            text << settings.nearField.reach << " m is longer than the periodic DEM box in "
                 << "xyz"[axis] << ", " << demBox.size()[axis] << " m. Use at most that, or a larger box";
            complaints.add(std::string(file) + ".nearField.reach", text.str());
        }
    }
    if (settings.method == "p3m") {
        checkP3m(settings.p3m, demBox, periodic, complaints);
        if (mesh && !mesh->unknownToP3m().empty()) {
            complaints.add(entry, "p3m can not be used here, because " + mesh->unknownToP3m() + ". Use him or himCell");
        }
    }
    if (method->needsCutoff) {
        // Only him decides by the distance of two charges and yet corrects by cells.
        checkCutoff(settings, settings.method == "him" ? mesh : nullptr, demBox, periodic, complaints);
    }
    if (method->sumsAll && (periodic[0] || periodic[1] || periodic[2])) {
        complaints.add(entry, settings.method
                                  + " sums every pair once, and in a periodic DEM box every charge has infinitely "
                                    "many copies. Use a DEM box without periodic directions, or another field method");
    }
    return complaints;
}

std::unique_ptr<FieldMethod> FieldMethod::create(const FieldSettings& settings, PoissonMesh* mesh, const Box& demBox,
                                                 const std::array<bool, 3>& periodic, MPI_Comm communicator,
                                                 PhaseTimes& times)
{
    const Complaints complaints = check(settings, mesh, demBox, periodic);
    if (!complaints.none()) {
        throw std::invalid_argument(complaints.text());
    }
    if (settings.method == "pairwiseSum") {
        return std::make_unique<PairwiseSum>(settings, communicator, times);
    }
    if (settings.method == "directTruncation") {
        return std::make_unique<DirectTruncation>(settings, demBox, periodic, communicator, times);
    }
    if (settings.method == "p3m") {
        return std::make_unique<P3m>(settings, *mesh, demBox, periodic, communicator, times);
    }
    if (settings.method == "himCell") {
        return std::make_unique<HimCell>(settings, *mesh, demBox, periodic, communicator, times);
    }
    if (settings.method == "hybridParticleCell") {
        return std::make_unique<HybridParticleCell>(settings, *mesh, demBox, communicator, times);
    }
    return std::make_unique<Him>(settings, *mesh, demBox, periodic, communicator, times);
}

namespace {

class NoField : public FieldMethod {
public:
    void compute(const DemParticles& particles, ParticleField& result) override
    {
        result.field.setZero(particles.size(), 3);
    }
    double partnerCutoff() const override { return 0; }
    bool hasPotential() const override { return false; }
};

}  // namespace

std::unique_ptr<FieldMethod> FieldMethod::none()
{
    return std::make_unique<NoField>();
}

}  // namespace him
