// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/chargeTable.H"

#include "output/postProcessingFile.H"

#include <cmath>

namespace him {

chargeTable::chargeTable(const Foam::Time& runTime, const std::vector<DemWall>& walls, bool insulatingWalls)
    : walls_(walls.size()), file_(openPostProcessing(runTime, "charge", "charge.dat", 12))
{
    if (!file_.is_open()) {
        return;
    }
    file_ << "# Charge on the particles and given to the walls since the start. SI units: s, C, V/m, J.\n"
          << "# min, mean, max: of one particle. A column named after a DEM wall: charge given to it.\n"
          << "# closureError: what the charge books lack. energy: nan when the field method has no potential.\n"
          << "# Time total min mean max";
    for (const DemWall& wall : walls) {
        file_ << ' ' << wall.name;
    }
    file_ << " inserted removed leaked breakdown closureError largestField energy" << (insulatingWalls ? " wallFaces wallFaceError" : "") << std::endl;
}

void chargeTable::write(double time, const CoupledStep& step)
{
    const StepSummary& summary = step.summary();
    const ChargeBooks& books = step.books();
    if (!file_.is_open()) {
        return;
    }
    const double mean = summary.particles > 0 ? summary.totalCharge / static_cast<double>(summary.particles) : 0;
    file_ << time << ' ' << summary.totalCharge << ' ' << summary.smallestCharge << ' ' << mean << ' '
          << summary.largestCharge;
    const ChargeMovements& moved = books.movements();
    for (std::size_t wall = 0; wall < walls_; ++wall) {
        file_ << ' ' << (moved.toWall.empty() ? 0 : moved.toWall[wall]);  // empty until something has moved
    }
    file_ << ' ' << moved.inserted << ' ' << moved.removed << ' ' << moved.leaked << ' ' << moved.breakdown << ' '
          << books.closureError() << ' ' << summary.largestField << ' ';
    if (std::isnan(summary.energy)) {
        file_ << "nan";
    } else {
        file_ << summary.energy;
    }
    if (step.hasInsulatingWalls()) {
        file_ << ' ' << step.wallFaceCharge() << ' ' << step.wallFaceError();
    }
    file_ << std::endl;
}

}  // namespace him
