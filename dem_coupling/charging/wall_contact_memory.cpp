// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem_coupling/charging/wall_contact_memory.hpp"

#include "electrostatics/constants.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace him {
namespace {

constexpr double notTouched = -1.0;

double dot(const double* a, const double* b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

}  // namespace

WallContactMemory::WallContactMemory(double curvature) : cosCurvature_(std::cos(curvature * pi / 180.0))
{
    if (!(curvature > 0 && curvature < 90)) {
        throw std::invalid_argument("curvature must be an angle between 0 and 90 degrees, found "
                                    + std::to_string(curvature));
    }
}

std::size_t WallContactMemory::pack(int row, double* buffer) const
{
    std::size_t n = 0;
    buffer[n++] = static_cast<double>(contacts_[row].size());
    for (const Contact& contact : contacts_[row]) {
        buffer[n++] = contact.wall;
        buffer[n++] = contact.area;
        buffer[n++] = contact.largestArea;
        for (const double component : contact.normal) {
            buffer[n++] = component;
        }
        buffer[n++] = contact.moved;
    }
    return n;
}

std::size_t WallContactMemory::unpack(int row, const double* buffer)
{
    std::size_t n = 0;
    occupiedKnown_ = false;
    contacts_[row].resize(static_cast<std::size_t>(buffer[n++]));
    for (Contact& contact : contacts_[row]) {
        contact.wall = static_cast<int>(buffer[n++]);
        contact.area = buffer[n++];
        contact.largestArea = buffer[n++];
        for (double& component : contact.normal) {
            component = buffer[n++];
        }
        contact.moved = buffer[n++];
        contact.newArea = notTouched;
    }
    return n;
}

WallContactMemory::Contact* WallContactMemory::find(int row, const WallTouch& touch)
{
    Contact* best = nullptr;
    double bestCosine = cosCurvature_;
    for (Contact& contact : contacts_[row]) {
        const double cosine = dot(contact.normal, touch.normal);
        if (contact.wall == touch.wall && cosine >= bestCosine) {
            best = &contact;
            bestCosine = cosine;
        }
    }
    return best;
}

void WallContactMemory::findOccupied(int rows)
{
    if (occupiedKnown_ && rows == rowsKnown_) {
        return;
    }
    occupied_.clear();
    for (int row = 0; row < rows; ++row) {
        if (!contacts_[row].empty()) {
            occupied_.push_back(row);
        }
    }
    occupiedKnown_ = true;
    rowsKnown_ = rows;
}

std::int64_t WallContactMemory::update(const std::vector<WallTouch>& touches, int rows, Reloading reloading,
                                       std::vector<GrowingWallContact>& growing)
{
    growing.clear();
    findOccupied(rows);
    const std::size_t before = occupied_.size();
    std::int64_t begun = 0;
    for (const WallTouch& touch : touches) {
        Contact* contact = find(touch.particle, touch);
        if (!contact) {
            if (contacts_[touch.particle].empty()) {
                occupied_.push_back(touch.particle);
            }
            contacts_[touch.particle].push_back({touch.wall, 0.0, 0.0, {0, 0, 0}, 0.0, notTouched});
            contact = &contacts_[touch.particle].back();
            ++begun;
        }
        if (touch.area > contact->newArea) {
            contact->newArea = touch.area;
            std::copy_n(touch.normal, 3, contact->normal);
        }
    }
    if (occupied_.size() > before) {
        std::sort(occupied_.begin(), occupied_.end());
    }
    for (const int row : occupied_) {
        auto& contacts = contacts_[row];
        contacts.erase(std::remove_if(contacts.begin(), contacts.end(), [](const Contact& c) { return c.newArea < 0; }),
                       contacts.end());
        for (Contact& contact : contacts) {
            const double reference = reloading == Reloading::counted ? contact.area : contact.largestArea;
            const double growth = contact.newArea - reference;
            if (growth > 0) {
                growing.push_back({row,
                                   contact.wall,
                                   growth,
                                   {contact.normal[0], contact.normal[1], contact.normal[2]},
                                   contact.newArea,
                                   &contact.moved});
            }
            contact.area = contact.newArea;
            contact.largestArea = std::max(contact.largestArea, contact.newArea);
            contact.newArea = notTouched;
        }
    }
    occupied_.erase(
        std::remove_if(occupied_.begin(), occupied_.end(), [this](int row) { return contacts_[row].empty(); }),
        occupied_.end());
    return begun;
}

}  // namespace him
