// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/near_field_refresh.hpp"

#include "dem_coupling/field_frequency.hpp"
#include "dem_coupling/field_methods/conducting_planes.hpp"
#include "dem_coupling/field_methods/shared_steps.hpp"
#include "electrostatics/constants.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace him {

namespace {

/// The smoother of the two clouds: its field has no kink at the reach.
constexpr int smoothCloud = 2;

}  // namespace

NearFieldRefresh::NearFieldRefresh(double reach, double permittivity, const std::vector<ImageWall>& planes,
                                   const Box& demBox, const std::array<bool, 3>& periodic, MPI_Comm communicator,
                                   PhaseTimes& times, NearPrecision precision)
    : reach_(reach),
      permittivity_(permittivity),
      planes_(planes),
      walls_(planes),
      communicator_(communicator),
      times_(times),
      halo_(reach, demBox, periodic, communicator),
      near_(reach, permittivity),
      precision_(precision),
      cloud_(reach, smoothCloud)
{
}

std::unique_ptr<NearFieldRefresh> NearFieldRefresh::create(const FieldSettings& settings, const PoissonMesh* mesh,
                                                           DemPort& dem, MPI_Comm communicator, PhaseTimes& times)
{
    const NearFieldSettings& near = settings.nearField;
    if (near.interval == 0) {
        return nullptr;
    }
    std::vector<ImageWall> planes;
    if (settings.method == "p3m") {
        planes = conductingPlanes(mesh->arrays(), communicator);
    } else if (settings.method == "pairwiseSum" && settings.pairwiseSum.images) {
        planes = settings.pairwiseSum.imageWalls;
        planes.erase(std::remove_if(planes.begin(), planes.end(),
                                    [](const ImageWall& wall) { return wall.shape != ImageWall::Shape::plane; }),
                     planes.end());
    }
    auto refresh = std::make_unique<NearFieldRefresh>(
        near.reach, settings.permittivity, planes, dem.box(), dem.periodic(), communicator, times,
        settings.method == "p3m" ? settings.p3m.nearPrecision : NearPrecision::doublePrecision);
    dem.setNearField(*refresh, near.interval);
    return refresh;
}

void NearFieldRefresh::compute(const DemParticles& particles, Points& field, Points& ownImages)
{
    {
        const PhaseTimer timer(times_, Phase::exchange);
        points_.position = particles.position;
        points_.charge = particles.charge;
        points_.cellCentre = particles.position;
        halo_.extend(points_);
    }
    std::string failure;
    sums_.pairs = 0;
    {
        const PhaseTimer timer(times_, Phase::near);
        ownImages.setZero(planes_.empty() ? 0 : particles.size(), 3);
        if (!planes_.empty()) {
            addImages(particles.size(), ownImages);
        }
        try {
            near_.screened(points_, cloud_, sums_, precision_);
        } catch (const std::domain_error& error) {
            failure = error.what();
        }
    }
    sumPairs(sums_.pairs, failure, particles, points_.position, communicator_);
    field = sums_.field;
}

double NearFieldRefresh::heldFrequency(const DemParticles& particles, const Points& field) const
{
    double largestCharge = particles.size() > 0 ? particles.charge.abs().maxCoeff() : 0;
    MPI_Allreduce(MPI_IN_PLACE, &largestCharge, 1, MPI_DOUBLE, MPI_MAX, communicator_);
    const double cloudGradient = cloud_.fieldCoefficient(0) / (4.0 * pi * permittivity_);
    double frequency = heldFieldFrequency(particles, field - sums_.field, reach_, cloudGradient, largestCharge);
    MPI_Allreduce(MPI_IN_PLACE, &frequency, 1, MPI_DOUBLE, MPI_MAX, communicator_);
    return frequency;
}

double NearFieldRefresh::heightAbovePlanes(const Vector3& point) const
{
    double height = std::numeric_limits<double>::lowest();
    for (const ImageWall& plane : planes_) {
        height = std::max(height, (point - plane.point).dot(plane.normal));
    }
    return height;
}

void NearFieldRefresh::addImages(Index particles, Points& ownImages)
{
    // The image of a charge is at least as far from any particle as the charge is from the wall.
    rowNearWalls_.clear();
    for (Index row = 0; row < points_.position.rows(); ++row) {
        if (heightAbovePlanes(points_.position.row(row).matrix().transpose()) > -reach_) {
            rowNearWalls_.push_back(row);
        }
    }
    const auto near = static_cast<Index>(rowNearWalls_.size());
    nearWalls_.resize(near, 3);
    chargeNearWalls_.resize(near);
    for (Index n = 0; n < near; ++n) {
        nearWalls_.row(n) = points_.position.row(rowNearWalls_[static_cast<std::size_t>(n)]);
        chargeNearWalls_[n] = points_.charge[rowNearWalls_[static_cast<std::size_t>(n)]];
    }
    walls_.make(nearWalls_, chargeNearWalls_, images_);

    const double coulombConstant = 1.0 / (4.0 * pi * permittivity_);
    const Index sources = points_.position.rows();
    Index kept = 0;
    for (Index n = 0; n < images_.position.rows(); ++n) {
        const Vector3 place = images_.position.row(n).matrix().transpose();
        if (heightAbovePlanes(place) >= reach_) {
            continue;
        }
        images_.position.row(kept) = place.transpose().array();
        images_.charge[kept++] = images_.charge[n];
        const Index owner = rowNearWalls_[static_cast<std::size_t>(images_.owner[static_cast<std::size_t>(n)])];
        const Vector3 r = points_.position.row(owner).matrix().transpose() - place;
        if (owner < particles && r.norm() < reach_) {
            const double scale =
                coulombConstant * images_.charge[kept - 1] * cloud_.shortRangeFieldCoefficient(r.norm());
            ownImages.row(owner) += (scale * r).transpose().array();
        }
    }
    points_.position.conservativeResize(sources + kept, 3);
    points_.charge.conservativeResize(sources + kept);
    points_.cellCentre.conservativeResize(sources + kept, 3);
    points_.position.bottomRows(kept) = images_.position.topRows(kept);
    points_.cellCentre.bottomRows(kept) = images_.position.topRows(kept);
    points_.charge.tail(kept) = images_.charge.head(kept);
}

}  // namespace him
