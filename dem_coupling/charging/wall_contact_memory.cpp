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

WallContactMemory::Contact* WallContactMemory::placeAtEnd(int row, std::size_t count)
{
    ranges_[row] = {contacts_.size(), count};
    contacts_.resize(contacts_.size() + count);
    inOrder_ = false;
    return contacts_.data() + ranges_[row].first;
}

void WallContactMemory::copyRow(int from, int to)
{
    const Range source = ranges_[from];
    if (source.count == 0) {
        clearRow(to);
        return;
    }
    placeAtEnd(to, source.count);
    std::copy_n(contacts_.begin() + static_cast<std::ptrdiff_t>(source.first), source.count,
                contacts_.begin() + static_cast<std::ptrdiff_t>(ranges_[to].first));
    occupiedKnown_ = false;
}

void WallContactMemory::clearRow(int row)
{
    ranges_[row] = Range();
    inOrder_ = false;
    occupiedKnown_ = false;
}

std::size_t WallContactMemory::pack(int row, double* buffer) const
{
    std::size_t n = 0;
    buffer[n++] = static_cast<double>(ranges_[row].count);
    for (std::size_t k = 0; k < ranges_[row].count; ++k) {
        const Contact& contact = contacts_[ranges_[row].first + k];
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
    const auto count = static_cast<std::size_t>(buffer[n++]);
    Contact* const contacts = placeAtEnd(row, count);
    for (std::size_t k = 0; k < count; ++k) {
        Contact& contact = contacts[k];
        contact.wall = static_cast<int>(buffer[n++]);
        contact.area = buffer[n++];
        contact.largestArea = buffer[n++];
        for (double& component : contact.normal) {
            component = buffer[n++];
        }
        contact.moved = buffer[n++];
        contact.newArea = notTouched;
    }
    occupiedKnown_ = false;
    return n;
}

WallContactMemory::Contact* WallContactMemory::find(int row, const WallTouch& touch)
{
    Contact* best = nullptr;
    double bestCosine = cosCurvature_;
    Contact* const first = contacts_.data() + ranges_[row].first;
    for (Contact* contact = first; contact != first + ranges_[row].count; ++contact) {
        const double cosine = dot(contact->normal, touch.normal);
        if (contact->wall == touch.wall && cosine >= bestCosine) {
            best = contact;
            bestCosine = cosine;
        }
    }
    return best;
}

WallContactMemory::Contact* WallContactMemory::begin(int row, int wall)
{
    const Range before = ranges_[row];
    Contact* const contacts = placeAtEnd(row, before.count + 1);
    std::copy_n(contacts_.data() + before.first, before.count, contacts);
    contacts[before.count] = {wall, 0.0, 0.0, {0, 0, 0}, 0.0, notTouched};
    return contacts + before.count;
}

void WallContactMemory::findOccupied(int rows)
{
    if (occupiedKnown_ && rows == rowsKnown_) {
        return;
    }
    occupied_.clear();
    for (int row = 0; row < rows; ++row) {
        if (ranges_[row].count > 0) {
            occupied_.push_back(row);
        }
    }
    // Rows beyond are those of particles that have gone.
    std::fill(ranges_.begin() + rows, ranges_.end(), Range());
    inOrder_ = false;
    occupiedKnown_ = true;
    rowsKnown_ = rows;
}

void WallContactMemory::layInOrder()
{
    next_.clear();
    for (const int row : occupied_) {
        Range& range = ranges_[row];
        const auto first = contacts_.begin() + static_cast<std::ptrdiff_t>(range.first);
        range.first = next_.size();
        next_.insert(next_.end(), first, first + static_cast<std::ptrdiff_t>(range.count));
    }
    contacts_.swap(next_);
    inOrder_ = true;
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
            if (ranges_[touch.particle].count == 0) {
                occupied_.push_back(touch.particle);
            }
            contact = begin(touch.particle, touch.wall);
            ++begun;
        }
        if (touch.area > contact->newArea) {
            contact->newArea = touch.area;
            std::copy_n(touch.normal, 3, contact->normal);
        }
    }
    if (occupied_.size() > before) {
        const auto added = occupied_.begin() + static_cast<std::ptrdiff_t>(before);
        std::sort(added, occupied_.end());
        merged_.resize(occupied_.size());
        std::merge(occupied_.begin(), added, added, occupied_.end(), merged_.begin());
        occupied_.swap(merged_);
    }
    if (!inOrder_) {
        layInOrder();
    }
    // Contacts and rows that go on move up to those that stay before them.
    Contact* kept = contacts_.data();
    std::size_t rowsKept = 0;
    for (const int row : occupied_) {
        Range& range = ranges_[row];
        const Contact* const first = contacts_.data() + range.first;
        const Contact* const end = first + range.count;
        range.first = static_cast<std::size_t>(kept - contacts_.data());
        for (const Contact* seen = first; seen != end; ++seen) {
            if (seen->newArea < 0) {
                continue;
            }
            if (kept != seen) {
                *kept = *seen;
            }
            Contact& contact = *kept++;
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
        range.count = static_cast<std::size_t>(kept - contacts_.data()) - range.first;
        if (range.count > 0) {
            occupied_[rowsKept++] = row;
        } else {
            range = Range();
        }
    }
    occupied_.resize(rowsKept);
    contacts_.resize(static_cast<std::size_t>(kept - contacts_.data()));
    return begun;
}

}  // namespace him
