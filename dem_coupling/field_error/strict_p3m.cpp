// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/field_error/strict_p3m.hpp"

#include <algorithm>
#include <sstream>

namespace him {

namespace {

constexpr double strictness = 1.5;      // clouds against those of the run
constexpr double leastStrictCells = 3;  // where the run has none

FieldSettings strictSettings(const FieldSettings& settings)
{
    FieldSettings strict = settings;
    strict.method = "p3m";
    strict.externalField.setZero();
    strict.ownResponse = false;
    const bool clouds = settings.method == "p3m";
    strict.p3m = {};
    strict.p3m.cloudCells =
        clouds ? std::max(leastStrictCells, strictness * settings.p3m.cloudCells) : leastStrictCells;
    strict.p3m.cloudRadius = clouds ? strictness * settings.p3m.cloudRadius : 0;
    strict.p3m.cloudExponent = 2;
    strict.p3m.gather = PolynomialOrder::quartic;
    strict.p3m.deferredCorrection = true;
    return strict;
}

}  // namespace

StrictP3mReference::StrictP3mReference(const FieldSettings& settings, PoissonMesh& mesh, const Box& demBox,
                                       const std::array<bool, 3>& periodic, MPI_Comm communicator)
    : settings_(strictSettings(settings)),
      mesh_(mesh),
      demBox_(demBox),
      periodic_(periodic),
      communicator_(communicator)
{
}

std::string StrictP3mReference::whyNot(const FieldSettings& settings, const PoissonMesh& mesh, const Box& demBox,
                                       const std::array<bool, 3>& periodic, MPI_Comm communicator)
{
    if (!mesh.unknownToP3m().empty()) {
        return "a stricter p3m would serve, but " + mesh.unknownToP3m();
    }
    std::int64_t cells = mesh.cellCount();
    MPI_Allreduce(MPI_IN_PLACE, &cells, 1, MPI_INT64_T, MPI_SUM, communicator);
    if (cells > mostCellsOfReference) {
        return "a stricter p3m serves on meshes of at most " + std::to_string(mostCellsOfReference)
               + " cells, and this one has " + std::to_string(cells);
    }
    const Complaints complaints = FieldMethod::check(strictSettings(settings), &mesh, demBox, periodic);
    return complaints.none() ? std::string() : "a stricter p3m would serve, but " + complaints.lines().front();
}

void StrictP3mReference::addField(const DemParticles& particles, const Points& targets,
                                  const std::vector<Index>& ownRow, Points& field) const
{
    const auto kept = mesh_.keep();
    if (!method_) {
        method_ = FieldMethod::create(settings_, &mesh_, demBox_, periodic_, communicator_, times_);
    }
    ParticleField result;
    method_->compute(particles, result);
    if (kept) {
        mesh_.restore(kept.get());
    }
    for (Index target = 0; target < targets.rows(); ++target) {
        const Index row = ownRow[static_cast<std::size_t>(target)];
        if (row >= 0) {
            field.row(target) += result.field.row(row);
        }
    }
}

std::string StrictP3mReference::description() const
{
    std::ostringstream text;
    text << "p3m with clouds of ";
    if (settings_.p3m.cloudRadius > 0) {
        text << settings_.p3m.cloudRadius << " m";
    } else {
        text << settings_.p3m.cloudCells << " cells";
    }
    text << ", quartic gather and deferred correction (stricter, not exact)";
    return text.str();
}

}  // namespace him
