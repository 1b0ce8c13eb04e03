// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/gas/gas_coupling.hpp"

#include "dem_coupling/gas/lift.hpp"
#include "electrostatics/constants.hpp"

#include <algorithm>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace him {

namespace {

/// [m3] of spheres of a radius [m], one number or many.
template <class Radius> auto sphereVolume(const Radius& radius)
{
    return 4 * pi / 3 * radius * radius * radius;
}

template <std::size_t N> std::array<double, N> sumOverRanks(std::array<double, N> values, MPI_Comm communicator)
{
    MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(N), MPI_DOUBLE, MPI_SUM, communicator);
    return values;
}

}  // namespace

GasCoupling::GasCoupling(DemPort& dem, const GasMesh& mesh, const GasSettings& settings, MPI_Comm communicator,
                         VelocityProfile* profile)
    : dem_(dem),
      mesh_(mesh),
      settings_(settings),
      communicator_(communicator),
      law_(dragOfMany(settings.drag)),
      lawHolds_(dragLawRange(settings.drag)),
      profile_(profile),
      shares_(mesh, communicator, dem.box(), dem.periodic(), settings.voidFraction == VoidFractionModel::divided),
      volume_(mesh.cellCount())
{
    for (Index cell = 0; cell < mesh_.cellCount(); ++cell) {
        volume_[cell] = mesh_.cellVolume(cell);
    }
    dragPoints_.density = settings.density;
    dragPoints_.viscosity = settings.viscosity;
    sources_.voidFraction.setOnes(mesh_.cellCount());
    sources_.drag.setZero(mesh_.cellCount());
    sources_.dragMomentum.setZero(mesh_.cellCount(), 3);
    sources_.owed.setZero(mesh_.cellCount(), 3);
}

void GasCoupling::smoothColumns(CellValues& ofCells, Index columns)
{
    if (settings_.voidFraction != VoidFractionModel::smoothed) {
        return;
    }
    for (Index k = 0; k < columns; ++k) {
        smoothed_ = ofCells.col(k);
        mesh_.smooth(smoothed_, settings_.smoothingLength);
        ofCells.col(k) = smoothed_;
    }
}

template <std::size_t N, class ValuesOf> void GasCoupling::toCells(const ValuesOf& valuesOf, CellValues& ofCells)
{
    shares_.deposit<N>(valuesOf, ofCells);
    ofCells.colwise() /= volume_;
    smoothColumns(ofCells, ofCells.cols());
}

void GasCoupling::begin(const DemParticles& particles)
{
    layVolumes(particles);
}

void GasCoupling::collect(const DemParticles& particles, const Points& velocity)
{
    layVolumes(particles);
    findDrag(particles, velocity);
    given_ = dem_.gasImpulse(owed_);
    laySources(particles);
    settleOwed();
}

void GasCoupling::resume(const DemParticles& particles, const GasResult& result, double duration, const Vector3& ahead)
{
    layVolumes(particles);
    if (dem_.gasForcesRestarted()) {
        books_.given = books_.ahead = ahead;
        return;
    }
    findDrag(particles, result.velocity);
    handBack(particles, result, duration);
    books_.given = books_.ahead = books_.promised;
}

void GasCoupling::layVolumes(const DemParticles& particles)
{
    shares_.locate(particles);
    forces_.volume = sphereVolume(particles.radius);
    toCells<1>([&](Index row) { return std::array<double, 1>{forces_.volume[row]}; }, solid_);
    sources_.voidFraction = solid_.col(0);

    std::array<double, 4> sums{};  // solid volume, particles outside, cells and volume below the bound
    double smallest = 1;
    for (Index cell = 0; cell < volume_.size(); ++cell) {
        double& voidFraction = sources_.voidFraction[cell];
        sums[0] += voidFraction * volume_[cell];
        voidFraction = 1 - voidFraction;
        smallest = std::min(smallest, voidFraction);
        if (voidFraction < settings_.smallestVoidFraction) {
            sums[2] += 1;
            sums[3] += (settings_.smallestVoidFraction - voidFraction) * volume_[cell];
            voidFraction = settings_.smallestVoidFraction;
        }
    }
    sums[1] = static_cast<double>(shares_.rowsOutside());
    sums = sumOverRanks(sums, communicator_);
    MPI_Allreduce(MPI_IN_PLACE, &smallest, 1, MPI_DOUBLE, MPI_MIN, communicator_);
    summary_.solidVolume = sums[0];
    summary_.particlesOutside = static_cast<std::int64_t>(sums[1]);
    summary_.boundedCells = static_cast<std::int64_t>(sums[2]);
    summary_.boundedVolume = sums[3];
    summary_.smallestVoidFraction = smallest;
    if (smallest < 0) {
        throw std::runtime_error("a cell of the gas holds " + std::to_string(1 - smallest)
                                 + " of its volume of particles. Nothing the gas does there would be right: write "
                                 + (settings_.voidFraction == VoidFractionModel::smoothed
                                        ? "a longer smoothingLength"
                                        : "voidFraction divided; or smoothed;")
                                 + " in constant/gasProperties, use larger cells, or look for overlapping particles");
    }
    if (summary_.particlesOutside > 0 && !settings_.particlesOutsideAllowed) {
        refuseOutside(particles);
    }
}

void GasCoupling::refuseOutside(const DemParticles& particles) const
{
    // The lowest tag of all ranks, and where it is.
    std::int64_t lowest = std::numeric_limits<std::int64_t>::max();
    Vector3 place = Vector3::Zero();
    for (Index row = 0; row < particles.size(); ++row) {
        if (!shares_.inMesh(row) && particles.tag[row] < lowest) {
            lowest = particles.tag[row];
            place = particles.position.row(row).matrix().transpose();
        }
    }
    std::int64_t named = lowest;
    MPI_Allreduce(MPI_IN_PLACE, &named, 1, MPI_INT64_T, MPI_MIN, communicator_);
    if (named != lowest) {
        place.setZero();
    }
    MPI_Allreduce(MPI_IN_PLACE, place.data(), 3, MPI_DOUBLE, MPI_SUM, communicator_);
    std::ostringstream text;
    text << summary_.particlesOutside << " particle(s) are outside the mesh of the gas, among them particle " << named
         << " at (" << place[0] << ' ' << place[1] << ' ' << place[2]
         << ") m. Check that the DEM walls lie on the mesh's, or write particlesOutsideMesh excluded; in "
            "constant/couplingProperties";
    throw std::runtime_error(text.str());
}

void GasCoupling::sumMotion(const DemParticles& particles)
{
    std::array<double, 7> sums{particles.mass.sum()};  // mass, its moments, momentum
    for (int axis = 0; axis < 3; ++axis) {
        sums[1 + static_cast<std::size_t>(axis)] = (particles.mass * particles.position.col(axis)).sum();
        sums[4 + static_cast<std::size_t>(axis)] = (particles.mass * particles.velocity.col(axis)).sum();
    }
    sums = sumOverRanks(sums, communicator_);
    summary_.momentum = Vector3(sums[4], sums[5], sums[6]);
    if (sums[0] > 0) {
        summary_.massCentre = Vector3(sums[1], sums[2], sums[3]) / sums[0];
    }
}

void GasCoupling::findDrag(const DemParticles& particles, const Points& velocity)
{
    const Index rows = particles.size();
    seen_.resize(volume_.size(), 4);
    seen_.leftCols(3) = velocity;
    seen_.col(3) = sources_.voidFraction;
    smoothColumns(seen_, 3);  // the void fraction is smooth already
    if (profile_) {
        findDeviations(particles);
    }
    dragPoints_.resize(rows);
    shares_.gather(seen_, [&](Index row, const double* gas) {
        double squared = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const double deviation = profile_ ? deviation_(row, axis) : 0;
            const double slip = gas[axis] + deviation - particles.velocity(row, axis);
            squared += slip * slip;
        }
        dragPoints_.slip[row] = std::sqrt(squared);
        dragPoints_.voidFraction[row] =
            shares_.inMesh(row) ? gas[3] : 0.5;  // any that the laws take; its drag is not used
        dragPoints_.diameter[row] = 2 * particles.radius[row];
    });
    law_(dragPoints_, beta_);

    forces_.drag.resize(rows);
    beyondDragLaw_ = 0;
    reachedBeyond_ = {-1, 0, 0};
    holdBeyond_ = ~DragLawSet(0);
    for (Index row = 0; row < rows; ++row) {
        if (!shares_.inMesh(row)) {
            forces_.drag[row] = forces_.volume[row] = 0;
            continue;
        }
        const DragPoint point = dragPoints_.at(row);
        if (!lawHolds_(point)) {
            ++beyondDragLaw_;
            const std::array<double, 3> reached{-point.voidFraction, point.voidFraction, superficialReynolds(point)};
            for (std::size_t n = 0; n < reached.size(); ++n) {
                reachedBeyond_[n] = std::max(reachedBeyond_[n], reached[n]);
            }
            holdBeyond_ &= dragLawsThatHold(point);
        }
        forces_.drag[row] =
            settings_.pressure == PressureModel::modelB ? dragOfModelB(beta_[row], point.voidFraction) : beta_[row];
    }
}

void GasCoupling::findDeviations(const DemParticles& particles)
{
    profile_->update(seen_.leftCols(3));
    shares_.gather(
        particles, [this](Index cell, const Vector3& point) { return profile_->deviation(cell, point); }, deviation_);
}

void GasCoupling::laySources(const DemParticles& particles)
{
    const auto valuesOf = [&](Index row) {
        std::array<double, 7> values{forces_.drag[row]};
        for (int axis = 0; axis < 3; ++axis) {
            const double deviation = profile_ ? deviation_(row, axis) : 0;
            const auto k = static_cast<std::size_t>(axis);
            values[1 + k] = forces_.drag[row] * (particles.velocity(row, axis) - deviation);
            values[4 + k] = owed_(row, axis);
        }
        return values;
    };
    toCells<7>(valuesOf, laid_);
    sources_.drag = laid_.col(0);
    sources_.dragMomentum = laid_.middleCols(1, 3);
    sources_.owed = laid_.rightCols(3);
}

void GasCoupling::settleOwed()
{
    std::array<double, 7> sums{};
    for (int axis = 0; axis < 3; ++axis) {
        const auto column = static_cast<std::size_t>(axis);
        sums[column] = given_[axis];
        sums[3 + column] = (sources_.owed.col(axis) * volume_).sum();
    }
    sums[6] = (sources_.drag * volume_).sum();
    sums = sumOverRanks(sums, communicator_);
    const Vector3 got(sums[0], sums[1], sums[2]);
    const Vector3 laid(sums[3], sums[4], sums[5]);
    books_.got += got;
    books_.ahead -= got;
    // Before this solve the gas must have given what the particles have got. What the deposit does not know of (particles
    // that left, meshes on which faces and cells do not weigh alike) is spread as the drag is.
    const Vector3 missing = -books_.ahead - laid;
    if (sums[6] > 0) {
        for (int axis = 0; axis < 3; ++axis) {
            sources_.owed.col(axis) += sources_.drag * (missing[axis] / sums[6]);
        }
    }
}

void GasCoupling::addUnpaidForces(const DemParticles& particles, Index row, const Vector3& acceleration,
                                  const Vector3& vorticity)
{
    const double displaced = settings_.density * forces_.volume[row];
    forces_.addedMass[row] = settings_.virtualMass * displaced;
    forces_.unpaid.row(row) = forces_.addedMass[row] * acceleration.transpose().array();
    if (settings_.saffmanLift && shares_.inMesh(row)) {
        const Vector3 slip = (forces_.velocity.row(row) - particles.velocity.row(row)).matrix().transpose();
        const double diameter = 2 * particles.radius[row];
        forces_.unpaid.row(row) +=
            saffmanLift(settings_.density, settings_.viscosity, diameter, slip, vorticity).transpose().array();
        beyondLift_ += !saffmanHolds(settings_.density, settings_.viscosity, diameter, slip, vorticity);
    }
}

void GasCoupling::handBack(const DemParticles& particles, const GasResult& result, double duration)
{
    const Index rows = particles.size();
    const bool feelsPressure = settings_.pressure == PressureModel::modelA;
    const bool feelsMotion = settings_.needsGasMotion();
    back_.resize(volume_.size(), 3 + (feelsPressure ? 3 : 0) + (feelsMotion ? 6 : 0));
    back_.leftCols(3) = result.velocity;
    if (feelsPressure) {
        back_.middleCols(3, 3) = result.pressureForce;
    }
    if (feelsMotion) {
        back_.rightCols(6).leftCols(3) = result.acceleration;
        back_.rightCols(3) = result.vorticity;
    }
    smoothColumns(back_, back_.cols());

    forces_.buoyancy = -settings_.density * settings_.gravity;
    forces_.velocity.resize(rows, 3);
    forces_.force.resize(feelsPressure ? rows : 0, 3);
    forces_.unpaid.resize(feelsMotion ? rows : 0, 3);
    forces_.addedMass.resize(feelsMotion ? rows : 0);
    beyondLift_ = 0;
    std::array<double, 5> sums{};  // force on the particles, those where drag law and lift do not hold
    shares_.gather(back_, [&](Index row, const double* gas) {
        for (int axis = 0; axis < 3; ++axis) {
            const double velocity = gas[axis] + (profile_ ? deviation_(row, axis) : 0);
            double force = forces_.drag[row] * (velocity - particles.velocity(row, axis));
            forces_.velocity(row, axis) = velocity;
            if (feelsPressure) {
                forces_.force(row, axis) = forces_.volume[row] * gas[3 + axis];
                force += forces_.force(row, axis);
            }
            sums[static_cast<std::size_t>(axis)] += force;
        }
        if (feelsMotion) {
            const double* const motion = gas + (feelsPressure ? 6 : 3);
            addUnpaidForces(particles, row, Vector3(motion), Vector3(motion + 3));
        }
    });
    dem_.setGasForces(forces_, duration);
    sums[3] = static_cast<double>(beyondDragLaw_);
    sums[4] = static_cast<double>(beyondLift_);
    sums = sumOverRanks(sums, communicator_);
    summary_.force = Vector3(sums[0], sums[1], sums[2]);
    summary_.beyondDragLaw = static_cast<std::int64_t>(sums[3]);
    summary_.beyondLift = static_cast<std::int64_t>(sums[4]);
    if (summary_.beyondDragLaw > 0) {
        MPI_Allreduce(MPI_IN_PLACE, reachedBeyond_.data(), 3, MPI_DOUBLE, MPI_MAX, communicator_);
        MPI_Allreduce(MPI_IN_PLACE, &holdBeyond_, 1, MPI_UNSIGNED, MPI_BAND, communicator_);
        summary_.voidFractionsBeyondDragLaw = {-reachedBeyond_[0], reachedBeyond_[1]};
        summary_.reynoldsBeyondDragLaw = reachedBeyond_[2];
        summary_.othersBeyondDragLaw = holdBeyond_;
    }
    books_.given += result.given;
    books_.ahead += result.given;
    books_.promised = duration * summary_.force;
    books_.moved += result.given.norm();
}

}  // namespace him
