// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/liggghts/liggghts_dem.hpp"

#include "dem_coupling/liggghts/contact_models.hpp"
#include "dem_coupling/liggghts/cut_domain.hpp"
#include "dem_coupling/liggghts/fix_constrain_plane.hpp"
#include "dem_coupling/liggghts/fix_enable_electric_field.hpp"
#include "dem_coupling/liggghts/fix_registry.hpp"
#include "dem_coupling/liggghts/particle_rows.hpp"
#include "dem_coupling/liggghts/private_access.hpp"

#include "atom.h"
#include "domain.h"
#include "input.h"
#include "modify.h"
#include "update.h"

#include <cmath>
#include <cstdio>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <unistd.h>

namespace him {

struct CurrentCommand {
    using Member = char* LAMMPS_NS::Input::*;
    friend Member memberOf(CurrentCommand);
};
template struct PrivateMember<CurrentCommand, &LAMMPS_NS::Input::command>;

namespace {

/// Id of the field fix that the host adds to the user's script.
constexpr const char* fieldFixId = "himFoamElectricField";
constexpr const char* dragFixId = "himFoamDrag";

std::unique_ptr<LAMMPS_NS::LAMMPS> start(const DemOptions& options, MPI_Comm communicator)
{
    std::vector<std::string> words{"himFoam", "-log", options.logFile.empty() ? "none" : options.logFile, "-screen",
                                   "/dev/null"};
    for (const auto& [name, value] : options.variables) {
        words.insert(words.end(), {"-var", name, value});
    }
    std::vector<char*> arguments;
    for (std::string& word : words) {
        arguments.push_back(word.data());
    }
    return std::make_unique<LAMMPS_NS::LAMMPS>(static_cast<int>(arguments.size()), arguments.data(), communicator);
}

/// The command that LIGGGHTS is carrying out, with its arguments.
std::string scriptLine(const LAMMPS_NS::Input& input)
{
    std::string line = input.*memberOf(CurrentCommand{});
    for (int i = 0; i < input.narg; ++i) {
        line += std::string(" ") + input.arg[i];
    }
    return line;
}

}  // namespace

std::unique_ptr<DemPort> openLiggghts(const DemOptions& options, MPI_Comm communicator)
{
    return std::make_unique<LiggghtsDem>(options, communicator);
}

LiggghtsDem::LiggghtsDem(const DemOptions& options, MPI_Comm communicator)
    : script_(options.script), communicator_(communicator), needsCharge_(options.needsCharge)
{
    if (chdir(options.directory.c_str()) != 0) {
        throw std::runtime_error("can not enter the case directory " + options.directory);
    }
    registerContactModels();
    FixChargeGranContact::hosted = true;
    lmp_ = start(options, communicator);
    if (lmp_->screen) {
        std::fclose(lmp_->screen);
        screen_ = std::make_unique<LiggghtsScreen>();
        lmp_->screen = screen_->stream();
        static char nothingYet[] = "";
        lmp_->input->*memberOf(CurrentCommand{}) = nothingYet;
        screen_->setScriptLine([this] { return scriptLine(*lmp_->input); });
    }
    registerFixes(lmp_.get());
    registerCutDomain(lmp_.get());
    lmp_->input->file(script_.c_str());

    for (const ListedWall& wall : listWalls(lmp_.get())) {
        walls_.push_back(wall.wall);
    }
    charging_ = FixChargeGranContact::find(lmp_.get());
    if (options.hasGas && lmp_->domain->box_exist) {
        // The drag is implicit in all forces of fixes before it, so the field's comes first.
        if (needsCharge_ && lmp_->atom->q_flag) {
            makeFieldFix();
        }
        // Now, because a fix that comes after the first set-up is not called.
        command(std::string("fix ") + dragFixId + " all couple/cfd/drag");
        drag_ = static_cast<FixCoupleCfdDrag*>(lmp_->modify->find_fix_id(dragFixId));
    }
    expected_ = lmp_->atom->natoms;
}

void LiggghtsDem::command(const std::string& line)
{
    lmp_->input->one(line.c_str());
}

// ---------------------------------------------------------------------- the scene

double LiggghtsDem::timeStep() const
{
    return lmp_->update->dt;
}

Box LiggghtsDem::box() const
{
    Box box;
    box.lower = Vector3(lmp_->domain->boxlo);
    box.upper = Vector3(lmp_->domain->boxhi);
    return box;
}

std::array<bool, 3> LiggghtsDem::periodic() const
{
    return {lmp_->domain->xperiodic != 0, lmp_->domain->yperiodic != 0, lmp_->domain->zperiodic != 0};
}

std::string LiggghtsDem::planeOfMotion() const
{
    const FixConstrainPlane* plane = FixConstrainPlane::find(lmp_.get());
    return plane ? plane->description() : std::string();
}

std::string LiggghtsDem::chargingDescription() const
{
    return charging_ ? charging_->description() : std::string();
}

bool LiggghtsDem::ranBeforeHandOver() const
{
    return lmp_->update->ntimestep > 0;
}

// ---------------------------------------------------------------------- settings

void LiggghtsDem::setWallRoles(const std::vector<WallRole>& roles)
{
    if (charging_) {
        charging_->setWallRoles(roles);
    }
}

void LiggghtsDem::setWallContactField(WallContactField field)
{
    if (charging_) {
        charging_->transfer().setWallContactField(field);
    }
}

void LiggghtsDem::setPermittivity(double permittivity)
{
    if (charging_) {
        charging_->transfer().setPermittivity(permittivity);
    }
}

void LiggghtsDem::setPartnerCutoff(double cutoff)
{
    // A method that knows no cutoff gives the whole field, which is what the script is after.
    const FixEnableElectricField* enabled = FixEnableElectricField::find(lmp_.get());
    if (enabled && std::isfinite(cutoff) && std::fabs(cutoff / enabled->cutoff() - 1) > 1e-9) {
        std::ostringstream text;
        text << script_ << ": field_cutoff_radius " << enabled->cutoff()
             << " m of enable_electric_field and the near cutoff " << cutoff
             << " m of constant/electrostaticProperties differ. Make them equal";
        throw std::runtime_error(text.str());
    }
    if (charging_) {
        charging_->transfer().setPartnerCutoff(cutoff);
    }
}

void LiggghtsDem::setNearField(NearFieldRefresh& near, long interval)
{
    near_ = &near;
    nearInterval_ = interval;
}

void LiggghtsDem::chargeParticles()
{
    if (charging_) {
        charging_->prepare();
    }
}

void LiggghtsDem::handOver()
{
    if (charging_) {
        charging_->handOver();
    }
    if (screen_) {
        screen_->quiet();
    }
    if (lmp_->logfile) {
        std::fprintf(lmp_->logfile,
                     "\n# Step " BIGINT_FORMAT ": handed over to himFoam, which reports in its own log.\n",
                     lmp_->update->ntimestep);
        std::fclose(lmp_->logfile);
        lmp_->logfile = nullptr;
    }
    // Set-up: neighbour lists, ghosts and the forces of the first step. Time does not advance.
    const Account before = account();
    command("run 0 post no");
    countParticles(before);
}

// ---------------------------------------------------------------------- the run

void LiggghtsDem::particles(DemParticles& out) const
{
    readRows(*lmp_->atom, out);
}

void LiggghtsDem::setField(const DemParticles& particles, const Points& field, const Points& ownResponse)
{
    if (particles.size() != lmp_->atom->nlocal || field.rows() != particles.size()) {
        throw std::logic_error("setField: the field is not that of the particles last read");
    }
    if (!needsCharge_) {
        return;
    }
    if (!field_) {
        makeFieldFix();
    }
    field_->setPointField(pointField_);
    if (near_) {
        field_->setNearField(*near_, nearInterval_);
        near_ = nullptr;
    }
    field_->setField(field, ownResponse);
}

void LiggghtsDem::makeFieldFix()
{
    field_ = FixCoupleCfdEfield::find(lmp_.get());
    if (!field_) {
        command(std::string("fix ") + fieldFixId + " all couple/cfd/efield");
        field_ = static_cast<FixCoupleCfdEfield*>(lmp_->modify->find_fix_id(fieldFixId));
    }
}

void LiggghtsDem::run(long steps)
{
    const Account before = account();
    command("run " + std::to_string(steps) + (setUpNext_ ? " pre yes" : " pre no") + " post no");
    setUpNext_ = false;
    countParticles(before);
}

void LiggghtsDem::setGasForces(const GasForces& forces, double duration)
{
    if (forces.drag.size() != lmp_->atom->nlocal) {
        throw std::logic_error("setGasForces: the forces are not those of the particles last read");
    }
    if (!drag_) {
        throw std::logic_error("setGasForces: DemOptions::hasGas is not set");
    }
    drag_->setForces(forces, duration);
}

bool LiggghtsDem::gasForcesRestarted() const
{
    int restarted = drag_ && drag_->restarted();
    MPI_Allreduce(MPI_IN_PLACE, &restarted, 1, MPI_INT, MPI_MAX, communicator_);
    return restarted != 0;
}

Vector3 LiggghtsDem::gasImpulse(Points& beyond) const
{
    if (drag_) {
        return drag_->impulse(beyond);
    }
    beyond.setZero(lmp_->atom->nlocal, 3);
    return Vector3::Zero();
}

LiggghtsDem::Account LiggghtsDem::account() const
{
    Account now;
    now.arrivals = field_ ? field_->arrivals() : drag_ ? drag_->arrivals() : 0;
    CompensatedSum charge;
    for (int i = 0; lmp_->atom->q && i < lmp_->atom->nlocal; ++i) {
        charge += lmp_->atom->q[i];
    }
    now.charge = charge.value();
    const ChargeMovements moved = movements();
    now.moved = moved.inserted - std::accumulate(moved.toWall.begin(), moved.toWall.end(), 0.0);
    return now;
}

/// LIGGGHTS' own count can not tell a particle that was taken out from one that was lost: it is the sum of what is there.
void LiggghtsDem::countParticles(const Account& before)
{
    const Account now = account();
    const double local[2] = {now.charge - before.charge, static_cast<double>(now.arrivals - before.arrivals)};
    double change[2];
    MPI_Allreduce(local, change, 2, MPI_DOUBLE, MPI_SUM, communicator_);
    expected_ += static_cast<std::int64_t>(change[1]);
    if (removalsAllowed_ && lmp_->atom->natoms < expected_) {
        // Only then: otherwise nothing may be missing, and the books must find out by themselves.
        removed_ += now.moved - before.moved - change[0];
        expected_ = lmp_->atom->natoms;
    }
}

ChargeMovements LiggghtsDem::movements() const
{
    ChargeMovements moved;
    if (charging_) {
        moved = charging_->movements();
    }
    moved.toWall.resize(walls_.size(), 0.0);
    moved.removed = removed_;
    return moved;
}

ContactCounts LiggghtsDem::contacts() const
{
    ContactCounts counts = charging_ ? charging_->contacts() : ContactCounts();
    counts.limitedForces = field_ ? field_->compute_limited() : 0;
    return counts;
}

void LiggghtsDem::takeWallCharges(std::vector<WallCharge>& out)
{
    out.clear();
    if (charging_) {
        charging_->takeWallCharges(out);
    }
}

std::vector<Vector3> LiggghtsDem::wallPoints(std::size_t wall) const
{
    return pointsOfMeshWall(lmp_.get(), walls_.at(wall).name);
}

void LiggghtsDem::writeCheckpoint(const std::string& file)
{
    command("write_restart " + file);
    setUpNext_ = true;
}

}  // namespace him
