// SPDX-License-Identifier: GPL-3.0-or-later
#include "electrostatics/point_checks.hpp"

#include <sstream>
#include <stdexcept>

namespace him {

std::string pointText(const Vector3& point)
{
    std::ostringstream text;
    text.precision(10);
    text << '(' << point.x() << ' ' << point.y() << ' ' << point.z() << ") m";
    return text.str();
}

void throwNotFinite(const char* what, Index row, double value)
{
    std::ostringstream message;
    message << "the " << what << " of row " << row << " must be finite (at most " << largestCoordinate << "), found "
            << value;
    throw std::domain_error(message.str());
}

void refuseSharedPosition(const Points& targets, Index target, const Points& sources, Index selfRow)
{
    const Vector3 point = targets.row(target).matrix();
    Index nearest = -1;
    double nearestSquared = largestCoordinate * largestCoordinate;
    for (Index row = 0; row < sources.rows(); ++row) {
        const double squared = (sources.row(row).matrix().transpose() - point).squaredNorm();
        if (row != selfRow && squared < nearestSquared) {
            nearest = row;
            nearestSquared = squared;
        }
    }
    if (nearestSquared > smallestDistance * smallestDistance) {
        return;
    }
    std::ostringstream message;
    if (selfRow >= 0) {
        message << "rows " << selfRow << " and " << nearest;
    } else {
        message << "target row " << target << " and source row " << nearest;
    }
    message << " share the position " << pointText(point) << "; their field would be infinite";
    throw std::domain_error(message.str());
}

}  // namespace him
